#include "runtime/trace/model/unroll.h"

#include <memory>
#include <optional>
#include <random>

#include <gtest/gtest.h>

#include "runtime/trace/traverse/traversal.h"
#include "tests/unit/trace/models.h"

namespace graftal {
namespace {

using test::empty_graph;
using test::place;
using test::traced;

DetailOptions options_of(double error_px, std::optional<unsigned> steps = {}) {
    DetailOptions options;
    options.error_px = error_px;
    options.steps = steps;
    return options;
}

/// The model from the eye, and the same of which every edge is followed by itself.
struct Pair {
    Pair(const Graph& graph, const DetailOptions& options, std::optional<Vec3> eye) {
        unrolled = traced(graph, options, eye);
        plain = traced(graph, options, eye);
        for (TraceNode& node : plain->nodes)
            node.unrolling_count = 0;
    }
    std::unique_ptr<TraceModel> unrolled, plain;
};

/// Compares many rays, and that fewer parts are visited where there are unrollings.
void expect_same(const Graph& graph, const DetailOptions& options, std::optional<Vec3> eye_at = {}) {
    const Pair models(graph, options, eye_at);
    ASSERT_FALSE(models.unrolled->unrollings.empty());
    Traversal traversal(*models.unrolled), plain(*models.plain);
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> unit(-1, 1);
    const Vec3& eye = models.plain->view.camera.location;
    std::size_t hits = 0;
    for (int i = 0; i < 20'000; ++i) {
        const Ray ray{eye, {0.5 * unit(random), 0.5 * unit(random), -1}};
        SurfaceHit a, b;
        const bool found = plain.closest(ray, {}, b);
        ASSERT_EQ(traversal.closest(ray, {}, a), found) << i;
        ASSERT_EQ(traversal.meets_any(ray, {}), found) << i;
        if (!found) continue;
        ++hits;
        ASSERT_NEAR(a.t, b.t, 1e-11 * b.t) << i;
        ASSERT_LT(glm::distance(a.normal, b.normal), 1e-6) << i;
        ASSERT_LT(glm::distance(a.rgb, b.rgb), 1e-12) << i;
        ASSERT_EQ(a.material, b.material);
    }
    EXPECT_GT(hits, 100u);
    EXPECT_LT(traversal.visits(), 2 * plain.visits()); // those twice as many rays
}

/// A chain of turned and shrunk balls with branches of two colours, some of them squeezed.
Graph twisted(double squeeze) {
    Graph graph = empty_graph();
    const ObjectId ball = graph.primitive(PrimitiveKind::sphere);
    const ObjectId self = graph.add({"self", {}, {}, {}, {}});
    const auto turned = [](double angle_deg) {
        return Affine::translate({0, 1.2, 0}) * Affine::rotate({0.3, 0.1, 1}, angle_deg) *
               Affine::scale(Vec3(0.6));
    };
    place(graph, self, ball, Affine::scale({0.2, 0.7, 0.2}), {{1, 0, 0}, 0.2});
    place(graph, self, self, turned(40), {{0, 1, 0}, 0.3});
    place(graph, self, self, turned(-50) * Affine::scale({1, 1, squeeze}), {{0, 0, 1}, 0.1});
    place(graph, graph.root, self, {});
    return graph;
}

TEST(Unroll, DrawsWhatSingleEdgesDraw) {
    for (const double error_px : {8.0, 1.0, 0.25}) {
        SCOPED_TRACE(error_px);
        expect_same(test::tetrahedron(), options_of(error_px));
        expect_same(test::tetrahedron(0.45), options_of(error_px));
        expect_same(twisted(1), options_of(error_px));
        expect_same(twisted(0.8), options_of(error_px));
    }
    for (const unsigned steps : {2u, 5u, 9u}) {
        SCOPED_TRACE(steps);
        expect_same(test::tetrahedron(), options_of(0, steps));
        expect_same(twisted(0.8), options_of(0, steps));
        expect_same(twisted(0.8), options_of(2, steps));
    }
}

TEST(Unroll, DrawsTheSameBesideThePicture) {
    // From close by, so that most is out of the picture, and coarser.
    for (const double error_px : {8.0, 1.0}) {
        SCOPED_TRACE(error_px);
        expect_same(test::tetrahedron(), options_of(error_px), Vec3(0.4, 0.3, 1.2));
        expect_same(test::tetrahedron(0.45), options_of(error_px), Vec3(0.4, 0.3, 1.2));
        expect_same(twisted(0.8), options_of(error_px), Vec3(0.2, 1.5, 1.5));
        DetailOptions in_world = options_of(0);
        in_world.error_world = 0.01 * error_px;
        expect_same(twisted(0.8), in_world, Vec3(0.2, 1.5, 1.5));
    }
}

/// Seven of the eight octants of a cube, in two colours, to the limit.
Graph dented() {
    Graph graph = empty_graph();
    const ObjectId cube = graph.primitive(PrimitiveKind::cube);
    const ObjectId self = graph.add({"self", {}, {}, {}, {}});
    for (int i = 0; i < 7; ++i) {
        const Vec3 corner(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
        place(graph, self, self, Affine::translate(0.5 * corner) * Affine::scale(Vec3(0.5)),
              {{i & 1, 0, 1}, 0.5});
    }
    graph.objects[self].terminal = Instance{cube, {}, {}, {}, {}};
    place(graph, graph.root, self, {});
    return graph;
}

TEST(Unroll, PartsThatAreAllCutAreOneTreeOfWhatIsDrawnOfThem) {
    for (const auto& [error_px, steps] : {std::pair(6.0, std::optional<unsigned>()), {2.0, {}}, {0.0, 4u}}) {
        SCOPED_TRACE(error_px);
        const DetailOptions options = options_of(error_px, steps);
        expect_same(dented(), options);
        expect_same(dented(), options, Vec3(0.3, 1.5, 2.2));
        const auto whole = traced(dented(), options), without = traced(dented(), options);
        for (Unrolling& unrolling : without->unrollings)
            unrolling.leaf_tree = no_tree;
        Traversal leaves(*whole), parts(*without);
        std::mt19937_64 random(5);
        std::uniform_real_distribution<double> unit(-1, 1);
        for (int i = 0; i < 5000; ++i) {
            const Ray ray{whole->view.camera.location, {0.3 * unit(random), 0.3 * unit(random), -1}};
            SurfaceHit a, b;
            const bool found = parts.closest(ray, {}, b);
            ASSERT_EQ(leaves.closest(ray, {}, a), found) << i;
            if (!found) continue;
            ASSERT_NEAR(a.t, b.t, 1e-12 * b.t) << i;
            ASSERT_EQ(a.normal, b.normal) << i;
        }
        EXPECT_LT(leaves.visits(), parts.visits());
    }
}

TEST(Unroll, StaysSmall) {
    Graph graph = empty_graph();
    const ObjectId ball = graph.primitive(PrimitiveKind::sphere);
    const ObjectId self = graph.add({"self", {}, {}, {}, {}});
    for (int i = 0; i < 5000; ++i)
        place(graph, self, i % 2 == 0 ? ball : self,
              Affine::translate({i, 0, 0}) * Affine::scale(Vec3(0.01)));
    place(graph, graph.root, self, {});
    EXPECT_LE(traced(graph, options_of(1))->unrollings.size(), 2u); // of each node its own parts
    EXPECT_LE(traced(test::tetrahedron(), options_of(1))->edges.size(), 6000u);
}

} // namespace
} // namespace graftal
