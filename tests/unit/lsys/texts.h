#pragma once

#include <string>

#include "compiler/lsys/parse/parser.h"

namespace graftal::testing {

struct ParsedLsys {
    SourceMap sources;
    Diagnostics diagnostics;
    LsysFile file;
};

inline void parse(const std::string& text, ParsedLsys& parsed) {
    const FileId file = parsed.sources.add("m.lsys", text);
    parsed.file = parse_lsys(parsed.sources, file, parsed.diagnostics);
}

} // namespace graftal::testing
