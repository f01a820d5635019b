#pragma once

#include <optional>
#include <vector>

#include "compiler/lsys/parse/ast.h"
#include "compiler/syntax/token_stream.h"

namespace graftal {

/// Parses a block of statements, `{ x = 1; if (x > y) { ... } }`; requires that a '{' is next. Errors are
/// reported, and nothing is given then. Names are not looked up.
std::optional<LsysCommands> parse_lsys_commands(TokenStream& stream);

/// `NAME = number, NAME = number, ...`, added to `variables`. False after an error; what lost its value is
/// then there without one, so that nothing more is said about its name.
bool parse_lsys_variables(TokenStream& stream, std::vector<LsysVariable>& variables);
/// `NAME[size] = number, ...` or `NAME[size][size]`, added to `variables`; values may be missing.
bool parse_lsys_array(TokenStream& stream, std::vector<LsysVariable>& variables);

/// Calls `visit(expression)` for all expressions of commands, those of commands inside included.
template<typename Commands, typename Visit> void for_each_expression(Commands& commands, const Visit& visit) {
    for (auto& command : commands) {
        for (auto& index : command.indices)
            visit(index);
        if (command.value) visit(*command.value);
        for (auto& arm : command.arms) {
            if (arm.condition) visit(*arm.condition);
            for_each_expression(arm.commands, visit);
        }
    }
}

/// Calls `visit(command)` for all commands that assign, in the order of the text.
template<typename Visit>
void for_each_assignment(const std::vector<LsysCommand>& commands, const Visit& visit) {
    for (const LsysCommand& command : commands) {
        if (command.kind == LsysCommand::Kind::assign) visit(command);
        for (const LsysCommandArm& arm : command.arms)
            for_each_assignment(arm.commands, visit);
    }
}

} // namespace graftal
