// Bytes -> a valid graph -> its text, which reads back to an equal graph.

#include <cstddef>
#include <cstdint>

#include "compiler/graph/text/print.h"
#include "compiler/languages/lower.h"
#include "compiler/support/check.h"
#include "tests/property/random_graph.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace graftal;
    testing::Choices choices(std::span(data, size));
    const bool runs = choices.one_in(3);
    const Graph graph =
        testing::random_graph(choices, {.max_objects = 12, .max_instances = 4, .runs = runs, .huge = 1e100});
    const std::string text = print(graph);
    SourceMap sources;
    Diagnostics diagnostics;
    const std::optional<Graph> again = lower_text("printed.inst", text, {}, sources, diagnostics).graph;
    // Words of other graphs may state a transform that the languages have no numbers for.
    if (!again) return 0;
    GRAFTAL_CHECK(equal(graph, *again), "print fuzzer: printed and read");
    // The parts of a run are written one by one, those of an object that are placed alike in one group.
    GRAFTAL_CHECK(runs || print(*again) == text, "print fuzzer: printed twice");
    return 0;
}
