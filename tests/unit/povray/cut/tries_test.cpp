#include <cmath>
#include <cstdint>
#include <optional>

#include <gtest/gtest.h>

#include "tests/unit/detail/models.h"
#include "tests/unit/povray/cut/cut_graph.h"

// Work of all tries, where the memory allows a coarser picture alone.

namespace graftal {
namespace {

/// A fractal of a solid pattern that is seen through tints, no two alike: meshes of hundreds of parts.
Graph tinted_stone() {
    Graph graph = test::pound_sign(3, true);
    Material stone;
    stone.name = "stone";
    stone.pattern.layers.emplace_back();
    graph.materials.push_back(stone);
    for (Object& object : graph.objects)
        if (object.terminal) object.terminal->material = 0;
    return graph;
}

struct Trial {
    std::optional<Cut> cut;
    std::uint64_t work = 0; ///< pieces and placements, in all tries
    std::size_t warnings = 0;
};

Trial cut_within(const Graph& graph, double error_px, std::uint64_t memory_bytes) {
    Trial trial;
    Control control;
    control.on_progress = [&](const Progress& progress) { trial.work = progress.done; };
    View view;
    view.size = {640, 480};
    view.camera.location = Vec3(0, 0, 4);
    view.camera.angle_deg = 40;
    Diagnostics diagnostics;
    trial.cut =
        test::cut_graph(graph, strong_components(graph), test::bounds_of(graph), view,
                        {.error_px = error_px, .memory_bytes = memory_bytes}, diagnostics, {}, control);
    trial.warnings = diagnostics.all().size();
    return trial;
}

TEST(Tries, ThoseThatDoNotFitCostLittleBesidesTheOneThatDoes) {
    const Graph graph = tinted_stone();
    constexpr std::uint64_t memory = 300'000'000;
    constexpr double asked_px = 3;
    const Trial tries = cut_within(graph, asked_px, memory);
    ASSERT_TRUE(tries.cut);
    const double steps = std::ceil(std::log(tries.cut->error_px / asked_px) / std::log(1.25) - 1e-6);
    EXPECT_GE(steps, 3) << "the test is of a model that does not fit by far";
    const Trial last = cut_within(graph, asked_px * std::pow(1.25, steps), memory);
    ASSERT_TRUE(last.cut);
    EXPECT_EQ(last.warnings, 0u) << "fits at once";
    EXPECT_EQ(last.cut->placement_count, tries.cut->placement_count);
    EXPECT_LE(tries.work, 5 * last.work);
}

} // namespace
} // namespace graftal
