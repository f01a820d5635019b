#include "compiler/lower/language.h"

#include "compiler/rifs/lower.h"
#include "compiler/rifs/parser.h"

namespace graftal {

namespace {

InnerStatements inner_of(const RifsFile& file) {
    return {file.statements, {}};
}

} // namespace

Language rifs_language() {
    return {.extension = "rifs",
            .keywords = rifs_keywords,
            .inner_keywords = {"map", "codes"},
            .parse = parse_tree<parse_rifs, inner_of, lower_rifs>};
}

} // namespace graftal
