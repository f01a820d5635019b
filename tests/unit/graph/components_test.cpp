#include "compiler/graph/components.h"

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "compiler/graph/masters_first.h"

namespace graftal {
namespace {

/// A graph from lists of masters; object 0 is the root.
Graph graph_of(const std::vector<std::vector<ObjectId>>& masters) {
    Graph graph;
    for (std::size_t i = 0; i < masters.size(); ++i) {
        Object object;
        object.name = "o" + std::to_string(i);
        for (const ObjectId master : masters[i]) {
            Instance instance;
            instance.master = master;
            object.instances.push_back(instance);
        }
        graph.add(std::move(object));
    }
    return graph;
}

TEST(Components, OfAGasket) {
    // sierpinski -> itself three times, and a leaf that ends
    const Components components = strong_components(graph_of({{0, 0, 0, 1}, {}}));
    EXPECT_EQ(components.members, (std::vector<std::vector<ObjectId>>{{1}, {0}}));
    EXPECT_EQ(components.component_of, (std::vector<std::uint32_t>{1, 0}));
    EXPECT_EQ(components.cyclic, (std::vector<bool>{false, true}));
    EXPECT_EQ(components.unending, (std::vector<bool>{true, false}));
    EXPECT_TRUE(components.any_cycle());
}

TEST(Components, UnendingIsWhatReachesACycleNotOnlyWhatLiesOnOne) {
    // 0 -> 1 -> 2 <-> 3 -> 4, and 5 apart
    const Components components = strong_components(graph_of({{1}, {2}, {3}, {2, 4}, {}, {4}}));
    EXPECT_EQ(components.unending, (std::vector<bool>{true, true, true, true, false, false}));
    EXPECT_EQ(components.members[components.component_of[2]], (std::vector<ObjectId>{2, 3}));
    EXPECT_TRUE(components.cyclic[components.component_of[3]]);
    EXPECT_FALSE(components.cyclic[components.component_of[1]]);
}

TEST(Components, AcyclicSharingIsNoCycle) {
    const Components components = strong_components(graph_of({{1, 2, 1}, {3}, {3}, {}}));
    EXPECT_FALSE(components.any_cycle());
    EXPECT_EQ(components.members.size(), 4u);
    EXPECT_FALSE(components.unending[0]);
}

TEST(Components, TerminalsAreNoEdges) {
    Graph graph = graph_of({{1}, {}});
    Instance terminal;
    terminal.master = 0;
    graph.objects[1].terminal = terminal;
    EXPECT_FALSE(strong_components(graph).any_cycle());
}

TEST(Components, DepthIsNoLimit) {
    constexpr ObjectId depth = 200'000;
    std::vector<std::vector<ObjectId>> masters(depth);
    for (ObjectId id = 0; id + 1 < depth; ++id)
        masters[id] = {id + 1};
    const Components chain = strong_components(graph_of(masters));
    EXPECT_EQ(chain.members.size(), depth);
    EXPECT_EQ(chain.component_of[depth - 1], 0u) << "masters first";
    masters[depth - 1] = {0};
    const Components ring = strong_components(graph_of(masters));
    EXPECT_EQ(ring.members.size(), 1u);
    EXPECT_EQ(ring.members[0].size(), depth);
}

TEST(Components, AgreeWithReachabilityOnRandomGraphs) {
    std::mt19937_64 random(11);
    for (int round = 0; round < 300; ++round) {
        const std::size_t count = 1 + random() % 12;
        std::vector<std::vector<ObjectId>> masters(count);
        std::vector<std::vector<bool>> reaches(count, std::vector<bool>(count, false));
        for (std::size_t i = 0; i < count; ++i) {
            for (std::size_t k = random() % 3; k > 0; --k) {
                masters[i].push_back(static_cast<ObjectId>(random() % count));
                reaches[i][masters[i].back()] = true;
            }
        }
        for (std::size_t k = 0; k < count; ++k)
            for (std::size_t i = 0; i < count; ++i)
                for (std::size_t j = 0; j < count; ++j)
                    if (reaches[i][k] && reaches[k][j]) reaches[i][j] = true;

        const Components components = strong_components(graph_of(masters));
        for (std::size_t i = 0; i < count; ++i) {
            bool reaches_a_cycle = reaches[i][i];
            for (std::size_t j = 0; j < count; ++j) {
                const bool same = i == j || (reaches[i][j] && reaches[j][i]);
                EXPECT_EQ(components.component_of[i] == components.component_of[j], same);
                if (reaches[i][j]) {
                    EXPECT_LE(components.component_of[j], components.component_of[i]);
                }
                reaches_a_cycle = reaches_a_cycle || (reaches[i][j] && reaches[j][j]);
            }
            EXPECT_EQ(components.cyclic[components.component_of[i]], reaches[i][i]);
            EXPECT_EQ(components.unending[i], reaches_a_cycle);
        }
    }
}

TEST(MastersFirst, FollowsWhatEachNodeLeadsTo) {
    struct Edge {
        std::uint32_t child;
    };
    // 0 -> 1 -> 2 -> 0, and 3 -> 1, 4
    const std::vector<std::vector<Edge>> edges = {{{1}}, {{2}}, {{0}}, {{1}, {4}}, {}};
    EXPECT_EQ(masters_first(edges.size(), [&](std::uint32_t node) { return edges[node]; }),
              (std::vector<std::uint32_t>{2, 1, 0, 4, 3}));
}

} // namespace
} // namespace graftal
