#include <utility>

#include "compiler/import/foreign_text.h"
#include "compiler/import/formats.h"
#include "compiler/import/houdini/fields.h"
#include "compiler/import/houdini/system.h"

namespace graftal {

namespace {

/// A model reaches from its premise to the next one; the first has what stands before it, too.
std::vector<ForeignModel> houdini_models(const ForeignFile& file) {
    const std::string_view text = file.text();
    std::vector<std::size_t> begins;
    for (const HoudiniLine& line : houdini_lines(text, 0, text.size()))
        if (line.field == HoudiniField::premise) begins.push_back(begins.empty() ? 0 : line.line);
    return models_at(file, begins);
}

/// A premise and a rule.
bool is_houdini(std::string_view text) {
    bool premise = false, rule = false;
    for (const HoudiniLine& line : houdini_lines(text, 0, text.size())) {
        premise = premise || line.field == HoudiniField::premise;
        rule = rule || (premise && line.field == HoudiniField::rule);
    }
    return rule;
}

std::optional<Translation> translate_houdini(const ForeignFile& file, const ForeignModel& model) {
    std::optional<HoudiniSystem> system = read_houdini(file, model);
    if (!system) return std::nullopt;
    return write_houdini(file, model, std::move(*system));
}

} // namespace

Importer houdini_importer() {
    return {.format = "Houdini L-system",
            .endings = {},
            .recognises = is_houdini,
            .sign = "lines 'Premise: ...' and 'Rule 1: symbol=replacement'",
            .models = houdini_models,
            .translation = translate_houdini,
            .most_bytes = 1'000'000};
}

} // namespace graftal
