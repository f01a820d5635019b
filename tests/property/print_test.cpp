// graftal print: the text of a graph reads back as an equal graph.

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "compiler/graph/components.h"
#include "compiler/graph/text/print.h"
#include "compiler/graph/verify.h"
#include "compiler/languages/lower.h"
#include "compiler/passes/pipeline.h"
#include "tests/property/random_graph.h"

namespace graftal::testing {
namespace {

/// Reads `text`; on failure the diagnostics are the failure's message.
std::optional<Graph> read(const std::string& text, std::string& messages) {
    SourceMap sources;
    Diagnostics diagnostics;
    std::optional<Graph> graph = lower_text("printed.inst", text, {}, sources, diagnostics).graph;
    messages = diagnostics.render(sources);
    return graph;
}

TEST(Print, ReadsBackEqualForRandomGraphs) {
    unsigned cyclic = 0;
    for (std::uint64_t seed = 0; seed < 1000; ++seed) {
        Choices choices(seed);
        const Graph graph = random_graph(
            choices, {.max_objects = 12, .cycles = seed % 3 != 0, .runs = seed % 4 == 0, .huge = 1e99});
        const std::string text = print(graph);
        std::string messages;
        const std::optional<Graph> back = read(text, messages);
        ASSERT_TRUE(back) << "seed " << seed << "\n" << messages << text;
        ASSERT_TRUE(verify(*back).empty());
        ASSERT_TRUE(equal(graph, *back)) << "seed " << seed << "\n" << text << "became\n" << print(*back);
        cyclic += strong_components(graph).any_cycle();
    }
    EXPECT_GT(cyclic, 300u);
}

TEST(Print, ReadsBackEqualAfterEveryPass) {
    for (std::uint64_t seed = 2000; seed < 2200; ++seed) {
        Choices choices(seed);
        PipelineOptions options;
        options.after_each = [&](const Pass& pass, const Graph& graph) {
            std::string messages;
            const std::optional<Graph> back = read(print(graph), messages);
            ASSERT_TRUE(back) << pass.name << ", seed " << seed << "\n" << messages;
            EXPECT_TRUE(equal(graph, *back)) << pass.name << ", seed " << seed << "\n" << print(graph);
        };
        run_passes(model_passes(), {random_graph(choices, {.runs = seed % 4 == 0, .huge = 1e99}), {}},
                   options);
    }
}

} // namespace
} // namespace graftal::testing
