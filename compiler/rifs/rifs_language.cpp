#include "compiler/rifs/rifs_language.h"

#include "compiler/rifs/lower_rifs.h"
#include "compiler/rifs/rifs_parser.h"

namespace graftal {

namespace {

InnerStatements inner_statements(FileId file, const SourceMap& sources) {
    Diagnostics quiet;
    return {parse_rifs(sources, file, quiet).statements, {}};
}

} // namespace

Language rifs_language() {
    return {.extension = "rifs",
            .keywords = {"rifs", "main", "orbit", "use"},
            .inner_keywords = {"map", "codes"},
            .inner_statements = inner_statements,
            .lower = lower_rifs};
}

} // namespace graftal
