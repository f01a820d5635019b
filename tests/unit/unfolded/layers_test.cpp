#include "compiler/unfolded/layers.h"

#include <cstddef>

#include <gtest/gtest.h>

#include "compiler/detail/graph/edge_cell.h"
#include "tests/unit/unfolded/models.h"

namespace graftal {
namespace {

TEST(Layers, PartsOfRunsAreCopiesOfTheirPrimitivesToo) {
    Graph graph = test::empty_graph();
    auto run = std::make_shared<graftal::Run>();
    for (int i = 0; i < 3; ++i) {
        RunItem item;
        item.base = Vec3(i, 0, 0);
        item.axis = Vec3(0, 1, 0);
        item.radius = 0.1;
        item.shape = i == 0 ? PrimitiveKind::cone : PrimitiveKind::cylinder;
        run->add(item);
    }
    Object twigs{"twigs", {}, {}, {}, {}};
    twigs.packed.run = run;
    twigs.packed.materials.emplace_back();
    const ObjectId branch = graph.add({"branch", {}, {}, {}, {}});
    const ObjectId master = graph.add(std::move(twigs));
    test::place(graph, branch, master, {});
    test::place(graph, branch, branch, Affine::translate(Vec3(0, 1, 0)) * Affine::scale(Vec3(0.9)));
    test::place(graph, graph.root, branch, {});
    DetailOptions options;
    options.steps = 2;
    const auto prepared = test::prepared(graph, options);
    const LayeredGraph layers = layered(prepared->cut, prepared->root_steps);
    ASSERT_EQ(layers.source.size(), layers.cut.nodes.size());
    ASSERT_NE(layers.cut.nodes.size(), prepared->cut.nodes.size()) << "nothing to copy";
    std::size_t parts = 0;
    for (const DetailNode& node : layers.cut.nodes) {
        if (node.cell) {
            EXPECT_EQ(edge_count(node, false), node.cell->count) << "no balls";
        }
        for_each_edge(node, false, [&](const DetailEdge& edge) {
            ASSERT_LT(edge.child, layers.cut.nodes.size());
            if (node.cell) {
                EXPECT_TRUE(layers.cut.nodes[edge.child].primitive);
                ++parts;
            }
        });
    }
    EXPECT_GE(parts, 3u);
}

} // namespace
} // namespace graftal
