#include "compiler/import/eisenscript.h"

#include "compiler/import/eisenscript_parser.h"
#include "compiler/import/eisenscript_writer.h"
#include "compiler/import/foreign_text.h"

namespace graftal {

namespace eisenscript {

/// A file is one script.
std::vector<ForeignModel> models(const ForeignFile& file) {
    return {{"scene", file.span(0, file.text().size())}};
}

std::optional<Translation> translate(const ForeignFile& file, const ForeignModel&) {
    const std::size_t errors = file.diagnostics.error_count();
    const Script script = parse(file);
    if (file.diagnostics.error_count() > errors) return std::nullopt;
    if (script.rules.front().actions.empty()) {
        file.diagnostics.error(file.span(0, 0),
                               "the script draws nothing: no action stands outside of its rules");
        return std::nullopt;
    }
    Translation translation = Writer(file, script).write();
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
