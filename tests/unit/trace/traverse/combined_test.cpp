// Intersections and differences as rays meet them, against the points that lie in them.

#include <cmath>
#include <memory>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "compiler/graph/verify.h"
#include "runtime/trace/traverse/traversal.h"
#include "tests/unit/trace/models.h"
#include "tests/unit/unfolded/random_solids.h"

namespace graftal {
namespace {

using namespace test;

/// The ray's boundaries one by one: between two of them all points are in, or all are out.
void expect_boundaries(const Membership& membership, std::uint32_t steps, Traversal& traversal,
                       const Ray& ray, double far, std::size_t& boundaries) {
    constexpr int samples = 60, most = 12;
    constexpr double beside = 1e-6; // a surface is met again where the ray starts on it
    double from = 0;
    bool in = membership(ray.origin, steps);
    ASSERT_EQ(traversal.meets_any(ray, {0, far}), [&] {
        SurfaceHit hit;
        return traversal.closest(ray, {0, far}, hit);
    }());
    for (int i = 0; i < most; ++i) {
        SurfaceHit hit;
        const bool met = traversal.closest(ray, {from + (i > 0 ? beside : 0), far}, hit);
        const double to = met ? hit.t : far;
        for (int k = 1; k < samples; ++k) {
            const double t = std::lerp(from, to, double(k) / samples);
            if (t - from < 2 * beside || to - t < 2 * beside) continue;
            ASSERT_EQ(membership(ray(t), steps), in) << "at " << t << " between " << from << " and " << to;
        }
        if (!met) return;
        ++boundaries;
        ASSERT_EQ(glm::dot(hit.normal, ray.direction) > 0, in) << "the normal at " << to;
        in = !in;
        from = to;
    }
}

class CombinedTest : public ::testing::TestWithParam<int> {};

TEST_P(CombinedTest, rays_meet_the_boundaries_of_the_points_that_lie_in_it) {
    std::size_t boundaries = 0;
    for (int seed = 50 * GetParam(); seed < 50 * (GetParam() + 1); ++seed) {
        SCOPED_TRACE(seed);
        RandomSolids random(static_cast<std::uint64_t>(seed));
        const Graph graph = random.graph();
        ASSERT_TRUE(verify(graph).empty()) << verify(graph).front().message;
        DetailOptions options;
        options.error_px = 0;
        options.steps = 3;
        const std::unique_ptr<TraceModel> model = traced(graph, options);
        const Membership membership(graph);
        Traversal traversal(*model);
        const Box& box = model->prepared.bounds;
        const double size = glm::length(box.size());
        for (int i = 0; i < 30 && !::testing::Test::HasFailure(); ++i) {
            const Vec3 target = box.centre() + 0.5 * random.vector() * box.size();
            if (membership(target, 3)) {
                const Vec3 least = box.min - 1e-9 * size, most = box.max + 1e-9 * size;
                EXPECT_TRUE(target == glm::clamp(target, least, most));
            }
            const Vec3 origin = i % 3 ? box.centre() + 1.2 * size * glm::normalize(random.vector()) : target;
            const Vec3 direction = i % 3 ? glm::normalize(target - origin) : glm::normalize(random.vector());
            expect_boundaries(membership, 3, traversal, {origin, direction}, 3 * size + 1, boundaries);
        }
        EXPECT_EQ(traversal.given_up(), 0u);
    }
    EXPECT_GT(boundaries, 300u);
}

INSTANTIATE_TEST_SUITE_P(Random, CombinedTest, ::testing::Range(0, 4));

/// A cube less another whose face lies in its own: the face is taken away, and leaves no skin.
TEST(CombinedFaces, that_coincide_leave_no_skin) {
    Graph graph = empty_graph();
    const ObjectId cube = graph.primitive(PrimitiveKind::cube);
    Object trough;
    trough.name = "trough";
    trough.combination = Combination::subtract;
    const ObjectId id = graph.add(std::move(trough));
    place(graph, id, cube, {});
    place(graph, id, cube, Affine::translate({0, 0.5, 0}) * Affine::scale({0.5, 0.5, 0.5}));
    place(graph, graph.root, id, Affine::rotate({1, 2, 3}, 20));
    const std::unique_ptr<TraceModel> model = traced(graph, {});
    Traversal traversal(*model);
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> inside(-0.49, 0.49);
    for (int i = 0; i < 1000; ++i) {
        const Affine map = Affine::rotate({1, 2, 3}, 20);
        const Vec3 floor = map(Vec3(inside(random), 0, inside(random)));
        const Vec3 from = map(Vec3(inside(random), 3, inside(random)));
        SurfaceHit hit;
        ASSERT_TRUE(traversal.closest({from, floor - from}, {0, INFINITY}, hit));
        ASSERT_NEAR(hit.t, 1, 1e-9);
        ASSERT_LT(glm::distance(hit.normal, map.linear * Vec3(0, 1, 0)), 1e-9);
    }
}

/// Parts that touch are one: what is taken away is whole where they meet.
TEST(CombinedFaces, of_parts_that_touch_leave_nothing_between_them) {
    Graph graph = empty_graph();
    const ObjectId cube = graph.primitive(PrimitiveKind::cube);
    Object tunnel;
    tunnel.name = "tunnel";
    tunnel.combination = Combination::subtract;
    const ObjectId id = graph.add(std::move(tunnel));
    place(graph, id, cube, {});
    for (int k = -5; k <= 5; ++k)
        place(graph, id, cube, Affine::translate({k / 5.0, 0, 0}) * Affine::scale(Vec3(0.1)));
    place(graph, graph.root, id, Affine::rotate({3, 1, 2}, 50));
    const std::unique_ptr<TraceModel> model = traced(graph, {});
    Traversal traversal(*model);
    const Affine map = Affine::rotate({3, 1, 2}, 50);
    const Vec3 along = map.linear * Vec3(1, 0, 0);
    for (int i = 0; i < 100; ++i) {
        const Vec3 from = map(Vec3(-3, 0.001 * i - 0.05, 0.0007 * i - 0.035));
        EXPECT_FALSE(traversal.meets_any({from, along}, {0, INFINITY})) << i;
    }
}

} // namespace
} // namespace graftal
