#include "compiler/lsys/lsys_language.h"

#include <algorithm>
#include <utility>

#include "compiler/lsys/lower_lsys.h"
#include "compiler/lsys/lsys_parser.h"
#include "compiler/lsys/lsys_scanner.h"

namespace graftal {

namespace {

const LsysBlock* main_block(const LsysFile& tree) {
    if (tree.blocks.empty()) return nullptr;
    const auto main = std::ranges::find_if(tree.blocks, [](const LsysBlock& block) { return block.is_main; });
    return main == tree.blocks.end() ? &tree.blocks.back() : &*main;
}

InnerStatements inner_statements(FileId file, const SourceMap& sources) {
    Diagnostics quiet;
    LsysFile tree = parse_lsys(sources, file, quiet);
    InnerStatements statements{std::move(tree.statements), {}};
    if (const LsysBlock* main = main_block(tree)) statements.block = main->lets;
    return statements;
}

} // namespace

Language lsys_language() {
    return {.extension = "lsys",
            .keywords = {"lsys", "main", "use"},
            .inner_keywords = {lsys_keywords().begin(), lsys_keywords().end()},
            .has_time = true,
            .inner_statements = inner_statements,
            .lower = lower_lsys};
}

} // namespace graftal
