// Intersections and differences as rays meet them, against the points that lie in them.

#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "compiler/graph/path.h"
#include "compiler/graph/verify.h"
#include "runtime/trace/traverse/traversal.h"
#include "tests/unit/trace/models.h"

namespace graftal {
namespace {

using test::empty_graph;
using test::place;
using test::traced;

bool lies_in(const Primitive& primitive, Vec3 p) {
    const double across = std::hypot(p.x, p.z);
    switch (primitive.kind()) {
    case PrimitiveKind::sphere:
        return glm::length(p) < 1;
    case PrimitiveKind::cube:
        return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) < 1;
    case PrimitiveKind::plane:
        return p.y < 0;
    case PrimitiveKind::cylinder:
        return p.y > 0 && p.y < 1 && across < 1;
    case PrimitiveKind::cone:
        return p.y > 0 && across < 1 - p.y;
    case PrimitiveKind::frustum:
        return p.y > 0 && p.y < 1 && across < 1 - p.y * (1 - primitive.steps() / double{frustum_steps});
    case PrimitiveKind::torus:
        return std::hypot(across - 1, p.y) < 0.25;
    default:
        ADD_FAILURE() << "no rule for " << name_of(primitive);
        return false;
    }
}

/// The plain meaning of a graph: the points that lie in what is drawn of it (graph.h).
class Membership {
  public:
    explicit Membership(const Graph& graph) : graph_(graph), components_(strong_components(graph)) {}

    bool operator()(Vec3 point, std::uint32_t steps) const { return holds(graph_.root, steps, point); }

  private:
    bool holds(ObjectId id, std::uint32_t steps, Vec3 point) const {
        const Object& object = graph_.objects[id];
        if (object.primitive) return lies_in(*object.primitive, point);
        const bool ended = components_.unending[id] && steps == 0;
        bool all = true, any = false;
        for (std::size_t i = 0; i < object.instances.size(); ++i) {
            const Instance& instance = object.instances[i];
            if (ended && components_.unending[instance.master]) continue;
            const std::uint32_t left = steps - levels_of(instance, components_);
            const bool in = holds(instance.master, left, inverse(instance.parent_from_child)(point));
            any = any || in;
            all = all && (object.combination == Combination::subtract && i > 0 ? !in : in);
        }
        return object.is_combined() ? all : any;
    }

    const Graph& graph_;
    const Components components_;
};

class RandomSolids {
  public:
    explicit RandomSolids(std::uint64_t seed) : random_(seed) {}

    Graph graph() {
        Graph graph = empty_graph();
        const ObjectId whole = combined(graph, 1 + below(3));
        place(graph, graph.root, whole, placement(0.5));
        return graph;
    }

    double unit() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
    Vec3 vector() { return {unit(), unit(), unit()}; }

  private:
    std::uint32_t below(std::uint32_t count) { return static_cast<std::uint32_t>(random_() % count); }

    Affine placement(double away) {
        Vec3 scale;
        for (int i = 0; i < 3; ++i)
            scale[i] = std::exp(0.5 * unit()) * (below(4) == 0 ? -1 : 1);
        if (below(2) == 0) scale = Vec3(scale.x);
        return Affine::translate(away * vector()) * Affine::rotate(glm::normalize(vector()), 180 * unit()) *
               Affine::scale(scale);
    }

    ObjectId object(Graph& graph, Combination combination) {
        Object object;
        object.name = "o" + std::to_string(graph.objects.size());
        object.combination = combination;
        return graph.add(std::move(object));
    }

    ObjectId solid(Graph& graph, std::uint32_t depth) {
        if (depth == 0) return primitive(graph);
        switch (below(4)) {
        case 0: {
            const ObjectId id = object(graph, Combination::unite);
            for (std::uint32_t i = 0; i < 2 + below(2); ++i)
                place(graph, id, solid(graph, depth - 1), placement(0.8));
            return id;
        }
        case 1:
            return recursive(graph);
        default:
            return combined(graph, depth);
        }
    }

    ObjectId primitive(Graph& graph) {
        constexpr PrimitiveKind kinds[] = {PrimitiveKind::sphere, PrimitiveKind::cube,
                                           PrimitiveKind::cylinder, PrimitiveKind::cone,
                                           PrimitiveKind::torus};
        const std::uint32_t kind = below(6);
        return graph.primitive(kind < 5 ? Primitive(kinds[kind]) : Primitive(PrimitiveKind::frustum, 64));
    }

    /// A primitive and smaller copies of all of it.
    ObjectId recursive(Graph& graph) {
        const ObjectId id = object(graph, Combination::unite);
        place(graph, id, primitive(graph), placement(0.3));
        for (std::uint32_t i = 0; i < 2; ++i)
            place(graph, id, id,
                  Affine::translate(0.9 * vector()) * Affine::rotate(glm::normalize(vector()), 90 * unit()) *
                      Affine::scale(Vec3(0.5)));
        return id;
    }

    ObjectId combined(Graph& graph, std::uint32_t depth) {
        const ObjectId id = object(graph, below(3) ? Combination::subtract : Combination::intersect);
        place(graph, id, solid(graph, depth - 1), placement(0.2));
        for (std::uint32_t i = 0; i < 1 + below(3); ++i) {
            const bool half_space = below(4) == 0;
            place(graph, id, half_space ? graph.primitive(PrimitiveKind::plane) : solid(graph, depth - 1),
                  placement(0.7));
        }
        return id;
    }

    std::mt19937_64 random_;
};

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
