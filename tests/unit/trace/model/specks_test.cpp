#include "runtime/trace/model/specks.h"

#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "runtime/trace/traverse/traversal.h"
#include "tests/unit/trace/models.h"

namespace graftal {
namespace {

using test::empty_graph;
using test::place;
using test::traced;

/// Four half-size copies of itself, turned and squeezed, to the limit, which has no area where they are not
/// turned; each drawn as these primitives.
Graph dust(const std::vector<PrimitiveKind>& kinds, double angle_deg, double squeeze) {
    Graph graph = empty_graph();
    std::vector<ObjectId> masters;
    for (const PrimitiveKind kind : kinds)
        masters.push_back(graph.primitive(kind));
    const ObjectId self = graph.add({"self", {}, {}, {}, {}});
    for (const Vec3 corner : {Vec3(1, 1, 1), Vec3(1, -1, -1), Vec3(-1, 1, -1), Vec3(-1, -1, 1)})
        place(graph, self, self,
              Affine::translate(0.5 * corner) * Affine::rotate({0.3, 0.1, 1}, angle_deg) *
                  Affine::scale({0.5, 0.5, 0.5 * squeeze}),
              {corner * 0.5 + 0.5, 0.5});
    if (!masters.empty()) {
        const ObjectId drawn = graph.add({"drawn", {}, {}, {}, {}});
        double turn = 0;
        for (const ObjectId master : masters)
            place(graph, drawn, master,
                  Affine::rotate({1, 0.2, 0}, turn += 70) * Affine::scale({0.5, 0.5, 0.9}));
        graph.objects[self].terminal = Instance{drawn, {}, {}, {}, {}};
    }
    place(graph, graph.root, self, {});
    return graph;
}

/// Compares many rays with those of the same model without specks.
void expect_same(const Graph& graph, double error_px, std::optional<Vec3> eye_at = {}) {
    DetailOptions options;
    options.error_px = error_px;
    const auto model = traced(graph, options, eye_at), plain = traced(graph, options, eye_at);
    ASSERT_FALSE(model->specks.empty());
    for (TraceNode& node : plain->nodes)
        node.speck_count = 0;
    for (Unrolling& unrolling : plain->unrollings)
        unrolling.most_speck_size = std::numeric_limits<double>::infinity();
    Traversal traversal(*model), without(*plain);
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> unit(-1, 1);
    std::size_t hits = 0;
    for (int i = 0; i < 10'000; ++i) {
        const Ray ray{plain->view.camera.location, {0.3 * unit(random), 0.3 * unit(random), -1}};
        SurfaceHit a, b;
        const bool found = without.closest(ray, {}, b);
        ASSERT_EQ(traversal.closest(ray, {}, a), found) << i;
        if (!found) continue;
        ++hits;
        ASSERT_EQ(a.t, b.t) << i;
        ASSERT_LT(glm::distance(a.rgb, b.rgb), 0.1) << i; // of parts that lie in one plane either is met
    }
    EXPECT_GT(hits, 100u);
    const bool several = plain->nodes[model->edges.front().child].stop_edge_count > 1;
    EXPECT_LE((several ? 2 : 1) * traversal.visits(),
              without.visits()); // one visit for all that one speck is
}

TEST(Specks, AreMetAsWithoutThem) {
    for (const double error_px : {4.0, 1.0}) {
        SCOPED_TRACE(error_px);
        expect_same(dust({PrimitiveKind::triangle, PrimitiveKind::triangle, PrimitiveKind::triangle}, 0, 1),
                    error_px);
        expect_same(dust({PrimitiveKind::cube, PrimitiveKind::triangle, PrimitiveKind::cylinder}, 0, 1),
                    error_px);
        expect_same(dust({PrimitiveKind::sphere}, 30, 1), error_px);
        expect_same(dust({PrimitiveKind::triangle}, 30, 1), error_px, Vec3(0.2, 0.1, 2.5));
        expect_same(dust({}, 0, 1), error_px);
    }
}

TEST(Specks, AreOnlyMadeWherePartsAreWidened) {
    DetailOptions options;
    options.error_px = 0;
    options.steps = 4;
    EXPECT_TRUE(traced(dust({PrimitiveKind::triangle}, 0, 1), options)->specks.empty());
}

TEST(Specks, ShearedModelsAreMetWithoutThem) {
    DetailOptions options;
    options.error_px = 1;
    const auto model = traced(dust({PrimitiveKind::triangle}, 20, 0.7), options);
    Traversal traversal(*model);
    for (const Unrolling& unrolling : model->unrollings)
        EXPECT_EQ(unrolling.most_speck_size, std::numeric_limits<double>::infinity());
}

} // namespace
} // namespace graftal
