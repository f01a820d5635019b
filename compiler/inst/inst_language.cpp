#include "compiler/inst/inst_language.h"

#include "compiler/inst/inst_parser.h"
#include "compiler/inst/lower_inst.h"

namespace graftal {

namespace {

InnerStatements inner_statements(FileId file, const SourceMap& sources) {
    Diagnostics quiet;
    return {parse_inst(sources, file, quiet).scene, {}};
}

} // namespace

Language inst_language() {
    return {.extension = "inst",
            .keywords = {"object", "canonical", "use"},
            .inner_keywords = {},
            .inner_statements = inner_statements,
            .lower = lower_inst};
}

} // namespace graftal
