#include "compiler/lsys/set_block.h"

#include <optional>
#include <string>
#include <utility>

#include "compiler/lower/lower_settings.h"

namespace graftal {

namespace {

/// `set`: by the caller, in place of the text.
void note_setting(const char* name, const Expression& text, std::optional<double> set,
                  const Environment& lets, Lowering& lowering) {
    Diagnostics quiet; // the grammar reports what is wrong
    const std::optional<double> value = set ? set : evaluate(text, lets, quiet);
    if (value) note_parameter(ModelParameter::Kind::setting, name, text, *value, lowering);
}

} // namespace

LsysBlock set_block(LsysBlock block, Environment lets, Lowering& lowering) {
    const std::pair<const char*, std::optional<LsysValue>*> settings[] = {{"angle", &block.angle},
                                                                          {"step", &block.step},
                                                                          {"width", &block.width},
                                                                          {"thickness", &block.thickness},
                                                                          {"seed", &block.seed}};
    const auto literal = [](double value) {
        Expression expression;
        expression.number = value;
        return expression;
    };
    for (LsysVariable& variable : block.variables) {
        const auto value = set_value(variable.name.text, {}, lowering);
        if (value && variable.sizes.empty()) variable.values.assign(1, literal(*value));
        lets.try_emplace(std::string(variable.name.text)); // it comes before a setting of its name
    }
    for (const auto& [name, setting] : settings) {
        const std::optional<double> value = set_value(name, lets, lowering);
        if (*setting) note_setting(name, (*setting)->value, value, lets, lowering);
        if (value) *setting = LsysValue{literal(*value), Span()};
    }
    const std::optional<double> steps = set_value("steps", lets, lowering);
    if (block.steps && block.steps->value) note_setting("steps", *block.steps->value, steps, lets, lowering);
    if (steps) block.steps = LsysSteps{literal(*steps), Span()};
    return block;
}

} // namespace graftal
