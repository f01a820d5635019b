#include "compiler/import/cfdg/parse/parser.h"
#include "compiler/import/cfdg/unfolding.h"
#include "compiler/import/foreign_text.h"
#include "compiler/import/formats.h"

namespace graftal {

namespace cfdg {

std::optional<Translation> translate(const ForeignFile& file, const ForeignModel&) {
    const std::size_t errors = file.diagnostics.error_count();
    const Grammar grammar = parse(file);
    if (file.diagnostics.error_count() > errors) return std::nullopt;
    return Unfolding(file, grammar).write();
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
            .models = one_scene,
            .translation = cfdg::translate};
}

} // namespace graftal
