#include "runtime/trace/model/trace_model.h"

#include <gtest/gtest.h>

#include "tests/unit/trace/models.h"

namespace graftal {
namespace {

/// So many instances, in unions of 1000, of a group of four balls.
Graph groups_of_balls(int count) {
    Graph graph = test::empty_graph();
    const ObjectId ball = graph.primitive(PrimitiveKind::sphere);
    const ObjectId group = graph.add({"group", {}, {}, {}, {}});
    for (int i = 0; i < 4; ++i)
        test::place(graph, group, ball, Affine::translate(Vec3(2 * i, i, 0)));
    for (int first = 0; first < count; first += 1000) {
        const ObjectId row = graph.add({"row" + std::to_string(first), {}, {}, {}, {}});
        for (int i = first; i < first + 1000; ++i)
            test::place(graph, row, group, Affine::translate(Vec3(10 * (i % 1000), 1e-3 * i, 0)));
        test::place(graph, graph.root, row, Affine::translate(Vec3(0, 0, 0.1 * first)));
    }
    return graph;
}

TEST(TraceModel, SpellsSmallGroupsOutWhereEdgesAreFew) {
    const auto few = test::traced(groups_of_balls(2000), {});
    EXPECT_GT(few->edges.size(), 2u * 2000);
    constexpr int many = 201'000;
    const auto model = test::traced(groups_of_balls(many), {});
    EXPECT_LT(model->edges.size(), many + 1000u);
}

} // namespace
} // namespace graftal
