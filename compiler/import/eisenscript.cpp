#include "compiler/import/eisenscript.h"

#include <fmt/format.h>

#include "compiler/import/eisenscript_parser.h"
#include "compiler/import/eisenscript_writer.h"
#include "compiler/import/foreign_text.h"

namespace graftal {

namespace eisenscript {

/// A file is one script.
std::vector<ForeignModel> models(const ForeignFile& file) {
    return {{"scene", file.span(0, file.text().size())}};
}

constexpr std::size_t most_bytes = 1'000'000; ///< of a script

std::optional<Translation> translate(const ForeignFile& file, const ForeignModel&) {
    const std::size_t errors = file.diagnostics.error_count();
    if (file.text().size() > most_bytes) {
        file.diagnostics.error(file.span(0, 0),
                               fmt::format("a script has at most {} characters", most_bytes));
        return std::nullopt;
    }
    const Script script = parse(file);
    if (file.diagnostics.error_count() > errors) return std::nullopt;
    if (script.rules.front().actions.empty()) {
        file.diagnostics.error(file.span(0, 0),
                               "the script draws nothing: no action stands outside of its rules");
        return std::nullopt;
    }
    Writer writer(file, script);
    if (file.diagnostics.error_count() > errors) return std::nullopt;
    Translation translation = writer.write();
    if (file.diagnostics.error_count() > errors) return std::nullopt;
    return translation;
}

bool recognises(std::string_view text) {
    return !is_binary(text);
}

} // namespace eisenscript

Importer eisenscript_importer() {
    static constexpr std::string_view endings[] = {"es"};
    return {.format = "EisenScript",
            .endings = endings,
            .recognises = eisenscript::recognises,
            .models = eisenscript::models,
            .translate = eisenscript::translate};
}

} // namespace graftal
