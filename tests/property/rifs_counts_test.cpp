// The levels of `--steps` are the maps of a `.rifs` model: leaves are counted by unfolding.

#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include "compiler/graph/unfold.h"
#include "compiler/languages/lower.h"
#include "tests/unit/languages/lower_file.h"

namespace graftal {
namespace {

std::uint64_t leaves(const std::string& scene, unsigned steps) {
    SourceMap sources;
    Diagnostics diagnostics;
    Status status;
    const auto graph = test::lower_file(std::string(GRAFTAL_SOURCE_DIR) + "/scenes/" + scene + ".rifs", {},
                                        sources, diagnostics, status)
                           .graph;
    EXPECT_TRUE(graph) << status.message() << diagnostics.render(sources);
    if (!graph) return 0;
    std::uint64_t count = 0;
    EXPECT_TRUE(unfold(*graph, strong_components(*graph), steps, 10'000'000, [&](const UnfoldedLeaf&) {
        ++count;
        return true;
    }));
    return count;
}

/// `first` at one step, then `factor` times as many at each.
void expect_growth(const std::string& scene, std::uint64_t first, std::uint64_t factor) {
    for (unsigned steps = 1; steps <= 4; ++steps, first *= factor)
        EXPECT_EQ(leaves(scene, steps), first) << scene << " at " << steps;
}

TEST(RifsCounts, poundSignsForbidRepeats) {
    expect_growth("hart/pound_sign", 8, 7);
    expect_growth("hart/pound_sign_2d", 4, 3);
}

TEST(RifsCounts, withAllEdgesEveryMapFollowsEveryMap) {
    expect_growth("ifs/menger_sponge", 20, 20);
    expect_growth("ifs/sierpinski_carpet", 8, 8);
    expect_growth("ifs/koch_curve", 4, 4);
    expect_growth("ifs/twin_dragon", 2, 2);
    expect_growth("ifs/sierpinski_tetrahedron", 4 * 4, 4); // four faces each
}

TEST(RifsCounts, mutuallyRecursiveObjectsTakeTurns) {
    EXPECT_EQ(leaves("ifs/graph_directed", 1), 20u);
    EXPECT_EQ(leaves("ifs/graph_directed", 2), 20u * 9);
    EXPECT_EQ(leaves("ifs/graph_directed", 3), 20u * 9 * 20);
    EXPECT_EQ(leaves("ifs/expanding_edge", 2), 12u); // `grow` is a level of its own
    EXPECT_EQ(leaves("ifs/expanding_edge", 3), 12u * 12);
    // Robinson's triangles: acute -> acute + obtuse, obtuse -> 2 obtuse + acute.
    std::uint64_t acute = 10;
    std::uint64_t obtuse = 0;
    for (unsigned steps = 1; steps <= 7; ++steps) {
        EXPECT_EQ(leaves("tilings/penrose", steps), acute + obtuse) << steps;
        const std::uint64_t acute_before = acute;
        acute = acute_before + obtuse;
        obtuse = acute_before + 2 * obtuse;
    }
}

} // namespace
} // namespace graftal
