#include "compiler/lower/language.h"

#include "compiler/lsys/lower.h"
#include "compiler/lsys/parse/parser.h"
#include "compiler/lsys/parse/scanner.h"

namespace graftal {

namespace {

InnerStatements inner_of(const LsysFile& file) {
    const LsysBlock* const main = main_block(file);
    return {file.statements, main ? main->lets : std::vector<SceneStatement>()};
}

} // namespace

Language lsys_language() {
    return {.extension = "lsys",
            .keywords = lsys_file_keywords,
            .inner_keywords = {lsys_keywords().begin(), lsys_keywords().end()},
            .has_time = true,
            .parse = parse_tree<parse_lsys, inner_of, lower_lsys>};
}

} // namespace graftal
