#include "compiler/unfolded/flat.h"

#include <type_traits>

#include <gtest/gtest.h>

#include "compiler/graph/unfold.h"
#include "compiler/passes/split_into_halves.h"
#include "tests/unit/unfolded/models.h"

namespace graftal {
namespace {

static_assert(std::is_trivially_copyable_v<FlatNode> && std::is_trivially_copyable_v<FlatEdge>);

struct Flattened {
    std::shared_ptr<const PreparedGraph> prepared;
    std::optional<FlatGraph> flat;
};

Flattened flattened(const Graph& graph, std::optional<unsigned> steps = {}, std::size_t most_edges = 1000) {
    DetailOptions options;
    options.steps = steps;
    Flattened made;
    made.prepared = test::prepared(graph, options);
    const LayeredGraph layers = layered(made.prepared->cut, made.prepared->root_steps);
    made.flat = flat_graph(layers, drawn_bounds(layers.cut), 0.5, most_edges);
    return made;
}

/// A stick, and two smaller copies of itself: turned and scaled, and sheared.
Graph shrub() {
    Graph graph = test::empty_graph();
    const ObjectId stick = graph.primitive(PrimitiveKind::cylinder);
    const ObjectId bush = graph.add({"bush", {}, {}, {}, {}});
    graph.materials.resize(1);
    graph.materials[0].name = "bark";
    test::place(graph, bush, stick, Affine::scale(Vec3(0.1, 1.0 / 3, 0.1)), {{0, 1, 0}, 0.25});
    const Affine turned{Mat3(0, 0.5, 0, -0.5, 0, 0, 0, 0, 0.5), Vec3(1.0 / 3, 1, 0)};
    test::place(graph, bush, bush, turned, {{1, 0, 0}, 0.5});
    test::place(graph, bush, bush, {Mat3(0.4, 0.1, 0, 0, 0.5, 0, 0, 0.2, 0.3), Vec3(-1, 2, 0.1)});
    graph.objects[bush].instances.back().material = 0;
    graph.objects[bush].terminal = Instance{stick, Affine::scale(Vec3(0.5)), {}, {}, {}};
    test::place(graph, graph.root, bush, Affine::translate(Vec3(1000, 0, 0)));
    return graph;
}

struct FlatLeaf {
    Affine world_from_leaf;
    Paint tint; ///< of the whole way
    std::uint32_t material = flat_none;
};

void walk(const FlatGraph& flat, std::uint32_t id, std::uint32_t steps, const FlatLeaf& at,
          std::vector<FlatLeaf>& leaves) {
    const FlatNode& node = flat.nodes[id];
    if (node.primitive != flat_none) return leaves.push_back(at);
    const bool cut = node.unending == 1 && steps == 0;
    const std::uint32_t first = node.first_edge + (cut ? node.edge_count : 0);
    for (std::uint32_t i = first; i < first + (cut ? node.stop_edge_count : node.edge_count); ++i) {
        const FlatEdge& edge = flat.edges[i];
        walk(flat, edge.child, steps - edge.levels,
             {at.world_from_leaf * parent_from_child(edge), edge.tint.under(at.tint),
              edge.material != flat_none ? edge.material : at.material},
             leaves);
    }
}

/// Holds the leaves of a walk over the arrays to those of unfold().
void expect_leaves(const Graph& graph, unsigned steps, double tolerance) {
    const Flattened made = flattened(graph, steps);
    ASSERT_TRUE(made.flat);
    std::vector<FlatLeaf> leaves;
    walk(*made.flat, made.flat->root, made.prepared->root_steps, {made.flat->world_from_root, {}}, leaves);
    std::size_t next = 0;
    unfold(graph, strong_components(graph), steps, 100'000, [&](const UnfoldedLeaf& leaf) {
        if (next == leaves.size()) return false;
        const FlatLeaf& found = leaves[next++];
        for (int k = 0; k < 3; ++k) {
            EXPECT_LE(largest_entry(found.world_from_leaf.linear[k] - leaf.world_from_object.linear[k]),
                      tolerance);
            EXPECT_NEAR(found.tint.fixed[static_cast<std::size_t>(k)], leaf.tint.premultiplied[k], 1e-6);
        }
        EXPECT_LE(largest_entry(found.world_from_leaf.translation - leaf.world_from_object.translation),
                  1000 * tolerance);
        EXPECT_NEAR(found.tint.open, 1 - leaf.tint.alpha, 1e-6);
        EXPECT_EQ(found.material, leaf.material.value_or(flat_none));
        return true;
    });
    EXPECT_EQ(next, leaves.size());
    EXPECT_EQ(next, (1u << steps) - 1);
}

TEST(FlatGraph, AWalkFindsTheLeavesOfTheGraph) {
    expect_leaves(shrub(), 1, 1e-14);
    expect_leaves(shrub(), 3, 1e-13);
    expect_leaves(shrub(), 8, 1e-12);
}

TEST(FlatGraph, HoldsWhatEachNodeDrawsInItsOwnCube) {
    const Flattened made = flattened(shrub(), 60);
    ASSERT_TRUE(made.flat);
    ASSERT_FALSE(made.flat->edges.empty());
    for (const FlatEdge& edge : made.flat->edges)
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_LT(edge.box[k], edge.box[k + 3]);
            EXPECT_GE(edge.box[k], -1.0001f);
            EXPECT_LE(edge.box[k + 3], 1.0001f);
        }
}

/// Half of a set's maps is never cut, and what would stand for it is no part of its box.
TEST(FlatGraph, HalvesHaveNoLargerBoxesThanTheWhole) {
    Graph graph = test::empty_graph();
    const ObjectId cube = graph.primitive(PrimitiveKind::cube),
                   sponge = graph.add({"sponge", {}, {}, {}, {}});
    for (int i = 0; i < 27; ++i) {
        const Vec3 at(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
        if (glm::dot(at, at) > 1.5)
            test::place(graph, sponge, sponge,
                        Affine::translate(2.0 / 3 * at) * Affine::scale(Vec3(1.0 / 3)));
    }
    graph.objects[sponge].terminal = Instance{cube, Affine::scale(Vec3(1)), {}, {}, {}};
    test::place(graph, graph.root, sponge, {});
    const Components components = strong_components(graph);
    graph = split_into_halves(graph, bound_objects(graph, components, decide_contraction(graph, components)))
                .graph;
    const std::shared_ptr<const PreparedGraph> prepared = test::prepared(graph, {});
    const DetailGraph cut = layered(prepared->cut, prepared->root_steps).cut;
    ASSERT_GT(cut.nodes.size(), 3u);
    const std::vector<Box> boxes = drawn_bounds(cut).node;
    std::size_t halves = 0;
    for (NodeId id = 0; id < cut.nodes.size(); ++id) {
        if (cut.nodes[id].cullable || cut.nodes[id].primitive) continue;
        ++halves;
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_GE(boxes[id].min[axis], -1.0001) << cut.nodes[id].name;
            EXPECT_LE(boxes[id].max[axis], 1.0001) << cut.nodes[id].name;
        }
    }
    EXPECT_EQ(halves, 2u);
}

TEST(FlatGraph, CyclesStayCycles) {
    const Flattened made = flattened(shrub(), 1'000'000), fewer = flattened(shrub(), 10'000);
    ASSERT_TRUE(made.flat && fewer.flat);
    EXPECT_EQ(made.flat->nodes.size(), fewer.flat->nodes.size());
    EXPECT_LE(made.flat->edges.size(), 5u);
}

TEST(FlatGraph, ANodeSaysWhereItIsCutAndWhatIsDrawnThen) {
    Graph graph = shrub();
    graph.objects[2].terminal_px = 24;
    const Flattened made = flattened(graph, 1'000'000);
    ASSERT_TRUE(made.flat);
    const FlatNode& root = made.flat->nodes[made.flat->root];
    const FlatNode& bush = made.flat->nodes[made.flat->edges[root.first_edge].child];
    EXPECT_EQ(root.unending, 1u);
    EXPECT_EQ(root.terminal, 0u);
    EXPECT_EQ(bush.edge_count, 3u);
    EXPECT_EQ(bush.stop_edge_count, 1u);
    EXPECT_EQ(bush.unending, 1u);
    EXPECT_EQ(bush.terminal, 1u);
    EXPECT_EQ(bush.cut_detail, 48) << "24 pixels in errors of half a pixel";
    EXPECT_GT(bush.diameter, 1);
    EXPECT_LT(bush.diameter, 4);
}

TEST(FlatGraph, IsNothingBeyondItsLimits) {
    EXPECT_FALSE(flattened(shrub(), 60, 3).flat) << "more edges than are allowed";
    Graph flat = test::empty_graph();
    const ObjectId floor = flat.add({"floor", {}, {}, {}, {}});
    test::place(flat, floor, flat.primitive(PrimitiveKind::plane), {});
    test::place(flat, floor, flat.primitive(PrimitiveKind::cube), {});
    test::place(flat, flat.root, floor, Affine::scale(Vec3(1, 0, 1)));
    EXPECT_FALSE(flattened(flat).flat) << "a map without thickness places a plane";
    flat.objects[flat.root].instances.front().parent_from_child = Affine::scale(Vec3(1000, 1e-4, 1000));
    EXPECT_TRUE(flattened(flat).flat) << "this one has some";
}

TEST(FlatGraph, KeepsSingularMapsAsTheyAre) {
    const Affine crush = Affine::rotate({1, 2, 3}, 40) * Affine::scale(Vec3(0.7, 0, 0.3));
    Graph graph = shrub();
    const ObjectId bush = graph.objects[graph.root].instances.front().master;
    test::place(graph, bush, graph.primitive(PrimitiveKind::cube), crush);
    const std::optional<FlatGraph> flat = flattened(graph, 60).flat;
    ASSERT_TRUE(flat);
    int crushed = 0;
    for (const FlatNode& node : flat->nodes)
        for (std::uint32_t i = 0; i < node.edge_count + node.stop_edge_count; ++i) {
            const FlatEdge& edge = flat->edges[node.first_edge + i];
            if (!edge.crushes) continue;
            ++crushed;
            EXPECT_EQ(node.widens, 1u);
            const Vec3 sigma = singular_values(parent_from_child(edge).linear);
            EXPECT_NEAR(sigma.y / sigma.x, 0.3 / 0.7, 1e-6);
            EXPECT_NEAR(sigma.z / sigma.x, 0, 1e-12);
        }
    EXPECT_GT(crushed, 0);
    EXPECT_EQ(flat->nodes[flat->root].widens, 1u);
}

TEST(FlatGraph, PlanesAndTheirHoldersHaveNoEndAndAreNeverCut) {
    Graph graph = shrub();
    const ObjectId room = graph.add({"room", {}, {}, {}, {}});
    test::place(graph, room, graph.root, {});
    test::place(graph, room, graph.primitive(PrimitiveKind::plane), {});
    graph.root = room;
    const Flattened made = flattened(graph, 60);
    ASSERT_TRUE(made.flat);
    const FlatNode& root = made.flat->nodes[made.flat->root];
    ASSERT_EQ(root.edge_count, 2u);
    EXPECT_EQ(root.unending, 0u);
    EXPECT_EQ(root.cut_detail, 0);
    EXPECT_LE(made.flat->edges[root.first_edge].box[3], 1.0001f);
    EXPECT_GE(made.flat->edges[root.first_edge + 1].box[3], flat_endless);
}

TEST(FloatPair, HoldsTwiceTheDigitsOfAFloat) {
    EXPECT_NEAR(FloatPair(1.0 / 3).value(), 1.0 / 3, 1e-15);
    EXPECT_EQ(FloatPair(0.75).low, 0);
}

} // namespace
} // namespace graftal
