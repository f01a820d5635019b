// `.lsys` from text to tree: any input gives a tree or diagnostics, soon.

#include <cstddef>
#include <cstdint>
#include <string>

#include "compiler/lsys/parse/parser.h"
#include "compiler/support/check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace graftal;
    SourceMap sources;
    Diagnostics diagnostics;
    const FileId file = sources.add("fuzz.lsys", std::string(reinterpret_cast<const char*>(data), size));
    const LsysFile tree = parse_lsys(sources, file, diagnostics);
    for (const LsysBlock& block : tree.blocks)
        for (const LsysProduction& production : block.productions)
            GRAFTAL_CHECK(!production.predecessor.symbol.empty(), "a production of a module");
    diagnostics.render(sources);
    return 0;
}
