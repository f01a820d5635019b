// Passes leave intersections and differences the same sets of points, within the same bounds, of as many
// parts.

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "compiler/analysis/bounding.h"
#include "compiler/analysis/contraction.h"
#include "compiler/analysis/counts.h"
#include "compiler/graph/components.h"
#include "compiler/graph/path.h"
#include "compiler/graph/text/print.h"
#include "compiler/graph/verify.h"
#include "compiler/passes/pipeline.h"
#include "compiler/passes/renumbering.h"
#include "tests/property/random_graph.h"

namespace graftal::testing {
namespace {

constexpr std::uint64_t combined_count = 1000;
constexpr unsigned most_steps = 3;

/// Whether the primitive holds a point of its own space, its surface included.
bool holds(const Primitive& primitive, Vec3 p) {
    const double across = p.x * p.x + p.z * p.z;
    switch (primitive.kind()) {
    case PrimitiveKind::sphere:
        return across + p.y * p.y <= 1;
    case PrimitiveKind::cube:
        return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= 1;
    case PrimitiveKind::cylinder:
        return p.y >= 0 && p.y <= 1 && across <= 1;
    case PrimitiveKind::frustum:
        return p.y >= 0 && p.y <= 1 && across <= (1 - 0.5 * p.y) * (1 - 0.5 * p.y);
    case PrimitiveKind::torus:
        return (std::sqrt(across) - 1) * (std::sqrt(across) - 1) + p.y * p.y <= 0.0625;
    case PrimitiveKind::plane:
        return p.y <= 0;
    default:
        ADD_FAILURE() << "no solid of these graphs";
        return false;
    }
}

/// The meaning of a graph as a set of points, in the plainest code. What ends at a level without a terminal
/// keeps the parts that end.
class PointSet {
  public:
    PointSet(const Graph& graph, unsigned steps)
        : graph_(graph), components_(strong_components(graph)), steps_(steps) {}

    bool has(Vec3 point) const { return has(PathState{graph_.root, {}, {}, {}, 0}, point); }
    /// The number of its primitives and proxies, those of all operands included.
    std::uint64_t count() const { return count(PathState{graph_.root, {}, {}, {}, 0}); }

  private:
    /// The instances that are drawn; none of a proxy.
    std::vector<Instance> parts_of(const PathState& place) const {
        const Object& object = graph_.objects[place.object];
        if (!components_.unending[place.object] || place.levels < steps_) return object.instances;
        if (object.terminal) return {*object.terminal};
        std::vector<Instance> parts;
        for (const Instance& instance : object.instances)
            if (!components_.unending[instance.master]) parts.push_back(instance);
        const bool is_proxy = object.combination == Combination::subtract &&
                              components_.unending[object.instances.front().master];
        return is_proxy ? std::vector<Instance>() : parts;
    }

    bool has(const PathState& place, Vec3 point) const {
        const Object& object = graph_.objects[place.object];
        if (object.primitive) return holds(*object.primitive, inverse(place.world_from_object)(point));
        std::vector<bool> parts;
        for (const Instance& instance : parts_of(place))
            parts.push_back(has(descend(place, instance, components_), point));
        if (parts.empty()) return false; // nobody says what a proxy holds
        if (object.combination == Combination::intersect) return std::ranges::count(parts, false) == 0;
        if (object.combination == Combination::unite) return std::ranges::count(parts, true) > 0;
        return parts.front() && std::ranges::count(parts, true) == 1;
    }

    std::uint64_t count(const PathState& place) const {
        if (graph_.objects[place.object].primitive) return 1;
        std::uint64_t sum = 0;
        for (const Instance& instance : parts_of(place))
            sum += count(descend(place, instance, components_));
        return std::max<std::uint64_t>(sum, 1);
    }

    const Graph& graph_;
    const Components components_;
    const unsigned steps_;
};

std::vector<Vec3> random_points(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> coordinate(-1.75, 1.75);
    std::vector<Vec3> points(60);
    for (Vec3& point : points)
        for (int i = 0; i < 3; ++i)
            point[i] = coordinate(random);
    return points;
}

std::vector<ObjectBounds> bounds_of(const Graph& graph) {
    const Components components = strong_components(graph);
    return bound_objects(graph, components, decide_contraction(graph, components));
}

bool is_within(Vec3 point, const ObjectBounds& bounds) {
    constexpr double slack = 1e-9;
    const Vec3 nearest = glm::clamp(point, bounds.box.min, bounds.box.max);
    return bounds.unbounded || (glm::distance(point, nearest) <= slack &&
                                glm::distance(point, bounds.ball.centre) <= bounds.ball.radius + slack);
}

/// How much the laws were tried on.
struct Tried {
    unsigned intersections = 0, differences = 0, inside = 0, within = 0, cyclic = 0;
};

/// `is_model`: the graph is one of a model, which stats counts.
void check(std::span<const Pass> passes, bool is_model, Graph graph, std::uint64_t seed, Tried& tried) {
    const std::vector<Vec3> points = random_points(seed);
    std::vector<ObjectBounds> bounds = bounds_of(graph);
    for (const Pass& pass : passes) {
        Rewritten after = pass.run(graph, bounds);
        const bool is_cut = strong_components(graph).unending[graph.root];
        Vec3 at{0.0};
        unsigned steps = 0;
        const auto where = [&] {
            return fmt::format("{}, seed {}, level {}, point {} {} {}\n", pass.name, seed, steps, at.x, at.y,
                               at.z) +
                   print(graph) + "\nbecame\n" + print(after.graph);
        };
        ASSERT_TRUE(verify(after.graph).empty()) << where();
        const std::vector<ObjectBounds> carried = carried_over(after.renumbering, bounds);
        const std::vector<ObjectBounds> anew = bounds_of(after.graph);
        for (steps = 0; steps <= most_steps; ++steps) {
            const PointSet before_it(graph, steps), after_it(after.graph, steps);
            ASSERT_EQ(after_it.count(), before_it.count()) << where();
            if (is_model) {
                ASSERT_EQ(count_leaves(after.graph, strong_components(after.graph), steps),
                          std::to_string(before_it.count()))
                    << where();
            }
            for (const Vec3& point : points) {
                at = point;
                const bool inside = before_it.has(point);
                ASSERT_EQ(after_it.has(point), inside) << where();
                tried.inside += inside;
                // Bounds are those of the limit set, which levels may widen.
                if (!inside || is_cut) continue;
                ++tried.within;
                ASSERT_TRUE(is_within(point, bounds[graph.root])) << where();
                ASSERT_TRUE(is_within(point, carried[after.graph.root])) << where();
                ASSERT_TRUE(is_within(point, anew[after.graph.root])) << where();
            }
        }
        graph = std::move(after.graph);
        bounds = carried;
    }
}

void check_all(bool for_detail) {
    Tried tried;
    for (std::uint64_t seed = 0; seed < combined_count; ++seed) {
        Choices choices(seed);
        const Graph graph = random_graph(choices, {.cycles = seed % 2 != 0,
                                                   .duplicates = !for_detail,
                                                   .settings = false,
                                                   .exact = true,
                                                   .mirrored = seed % 3 == 0,
                                                   .combined = true});
        ASSERT_TRUE(verify(graph).empty());
        for (const Object& object : graph.objects) {
            tried.intersections += object.combination == Combination::intersect;
            tried.differences += object.combination == Combination::subtract;
        }
        tried.cyclic += strong_components(graph).any_cycle();
        check(for_detail ? detail_passes() : model_passes(), !for_detail, graph, seed, tried);
        if (::testing::Test::HasFatalFailure()) return;
    }
    EXPECT_GT(tried.intersections, combined_count / 4);
    EXPECT_GT(tried.differences, combined_count / 4);
    EXPECT_GT(tried.cyclic, combined_count / 5);
    EXPECT_GT(tried.inside, 20 * combined_count);
    EXPECT_GT(tried.within, 10 * combined_count);
}

TEST(Combined, StaysTheSameSetOfPointsInEveryPassForModels) {
    check_all(false);
}

TEST(Combined, StaysTheSameSetOfPointsInEveryPassForDetail) {
    check_all(true);
}

} // namespace
} // namespace graftal::testing
