#include "compiler/lower/language.h"

#include "compiler/inst/lower.h"
#include "compiler/inst/parse/parser.h"

namespace graftal {

namespace {

InnerStatements inner_of(const InstModule& file) {
    return {file.scene, {}};
}

} // namespace

Language inst_language() {
    return {.extension = "inst",
            .keywords = inst_keywords,
            .inner_keywords = {},
            .parse = parse_tree<parse_inst, inner_of, lower_inst>};
}

} // namespace graftal
