// `.rifs` from text to verified graph: any input gives a graph or diagnostics, soon.

#include <cstddef>
#include <cstdint>
#include <string>

#include "compiler/lower/lower.h"
#include "compiler/support/check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace graftal;
    SourceMap sources;
    Diagnostics diagnostics;
    LowerOptions options;
    options.max_objects = 2000;
    std::string text(reinterpret_cast<const char*>(data), size);
    const std::optional<Graph> graph =
        lower_text("no_such_folder/fuzz.rifs", std::move(text), options, sources, diagnostics);
    GRAFTAL_CHECK(graph.has_value() != diagnostics.has_errors(), "rifs fuzzer: a graph or errors");
    diagnostics.render(sources);
    return 0;
}
