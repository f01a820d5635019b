#include "compiler/import/cfdg/importer.h"

#include "compiler/import/cfdg/parse/parser.h"
#include "compiler/import/cfdg/unfolding.h"
#include "compiler/import/foreign_text.h"

namespace graftal {

namespace cfdg {

/// A file is one grammar.
std::vector<ForeignModel> models(const ForeignFile& file) {
    return {{"scene", file.span(0, file.text().size())}};
}

std::optional<Translation> translate(const ForeignFile& file, const ForeignModel&) {
    const std::size_t errors = file.diagnostics.error_count();
    const Grammar grammar = parse(file);
    if (file.diagnostics.error_count() > errors) return std::nullopt;
    Translation translation = Unfolding(file, grammar).write();
    if (file.diagnostics.error_count() > errors) return std::nullopt;
    return translation;
}

bool recognises(std::string_view text) {
    return text.find("startshape") != std::string_view::npos;
}

} // namespace cfdg

Importer cfdg_importer() {
    static constexpr std::string_view endings[] = {"cfdg"};
    return {.format = "Context Free grammar",
            .endings = endings,
            .recognises = cfdg::recognises,
            .sign = "'startshape name', and rules",
            .models = cfdg::models,
            .translate = cfdg::translate};
}

} // namespace graftal
