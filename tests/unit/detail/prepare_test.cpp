#include "compiler/detail/prepare.h"

#include <gtest/gtest.h>

#include "compiler/analysis/contraction.h"

namespace graftal {
namespace {

Instance placed(ObjectId master, const Affine& map) {
    Instance instance;
    instance.master = master;
    instance.parent_from_child = map;
    return instance;
}

// A plane that a map crushes to a line draws nothing and has no edge.
TEST(PrepareCut, KeepsLevelsThatInstancesState) {
    Graph graph;
    const ObjectId plane = graph.primitive(PrimitiveKind::plane), cube = graph.primitive(PrimitiveKind::cube);
    const ObjectId self = graph.add({"self", {}, {}, {}, {}});
    graph.objects[self].instances = {placed(self, Affine::scale(Vec3(0.5))), placed(cube, {})};
    graph.root = graph.add({"root", {}, {}, {}, {}});
    graph.objects[graph.root].instances = {placed(plane, Affine::scale({1, 1, 0})),
                                           placed(self, Affine::translate(Vec3(4, 0, 0)))};
    graph.objects[graph.root].instances.back().levels = 3;
    const Components components = strong_components(graph);
    const auto bounds = bound_objects(graph, components, decide_contraction(graph, components));
    DetailOptions options;
    options.steps = 5;
    const PreparedGraph prepared = prepare_graph(graph, components, bounds, options.preparing());
    const DetailNode& root = prepared.cut.nodes[prepared.cut.root];
    ASSERT_EQ(root.edges.size(), 1u);
    EXPECT_EQ(root.edges[0].levels, 3u);
    EXPECT_EQ(prepared.root_steps, 5u);
}

} // namespace
} // namespace graftal
