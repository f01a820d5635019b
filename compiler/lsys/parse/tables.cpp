#include "compiler/lsys/parse/tables.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "compiler/lsys/parse/commands.h"

namespace graftal {

void connect_tables(LsysBlock& block, const ExpressionTables& tables) {
    if (tables.empty()) return;
    const auto connect = [&](Expression& expression) { connect_tables(expression, tables); };
    const auto connect_commands = [&](std::optional<LsysCommands>& commands) {
        if (commands) for_each_expression(commands->list, connect);
    };
    const auto connect_string = [&](LsysString& string) {
        for (LsysModule& module : string.modules)
            for (Expression& parameter : module.parameters)
                connect(parameter);
    };
    for (SceneStatement& let : block.lets)
        for (SceneField& field : let.fields)
            for (Expression& value : field.values)
                connect(value);
    const auto connect_all = [&](std::vector<Expression>& expressions) {
        std::ranges::for_each(expressions, connect);
    };
    for (std::optional<LsysValue>* value : {&block.angle, &block.step, &block.width, &block.thickness,
                                            &block.thinnest, &block.taper, &block.skin, &block.seed})
        if (*value) connect((*value)->value);
    if (block.steps && block.steps->value) connect(*block.steps->value);
    for (LsysDirection& statement : block.tropisms) {
        connect_all(statement.direction);
        if (statement.angle) connect(*statement.angle);
    }
    for (LsysEnvironment& statement : block.environment)
        connect_all(statement.numbers);
    for (LsysVariable& variable : block.variables) {
        connect_all(variable.sizes);
        connect_all(variable.values);
    }
    for (auto* commands : {&block.start, &block.start_each, &block.end_each, &block.end})
        connect_commands(*commands);
    if (block.axiom) connect_string(*block.axiom);
    for (std::vector<LsysProduction>* section : {&block.productions, &block.interpret, &block.decompose})
        for (LsysProduction& production : *section) {
            connect_commands(production.before);
            connect_commands(production.after);
            if (production.condition) connect(*production.condition);
            if (production.probability) connect(*production.probability);
            connect_string(production.successor);
        }
}

} // namespace graftal
