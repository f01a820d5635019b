// Triangles that lie in about one box are one item of a tree, and are met as each would be met alone.

#include "runtime/trace/model/leaf_group.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "runtime/trace/traverse/traversal.h"
#include "tests/unit/trace/models.h"

namespace graftal {
namespace {

using test::empty_graph;
using test::place;
using test::traced;

TEST(LeafGroup, IsOneItemOfATree) {
    for (const std::uint32_t first : {0u, 1u, 77u, (1u << 28) - 5})
        for (std::uint32_t count = 2; count <= LeafGroup::most; ++count) {
            const std::uint32_t item = LeafGroup(first, count).item();
            ASSERT_TRUE(LeafGroup::is(item));
            ASSERT_LT(item, BoxNode::inner);
            ASSERT_EQ(LeafGroup(item).first, first);
            ASSERT_EQ(LeafGroup(item).count, count);
        }
    EXPECT_EQ(LeafGroup(5, 1).item(), 5u);
    EXPECT_FALSE(LeafGroup::is(5));
    EXPECT_FALSE(LeafGroup::is(BoxNode::inner | BoxNode::packed | 5));
}

/// Triangles about the origin, in planes that are all but one, turned by quarters in these.
void add_fan(Graph& graph, ObjectId user, std::size_t count, double apart, const Affine& tilt, Vec3 size) {
    const ObjectId triangle = graph.primitive(PrimitiveKind::triangle);
    for (std::size_t i = 0; i < count; ++i) {
        const auto number = static_cast<double>(i);
        place(graph, user, triangle,
              Affine::translate(apart * number * Vec3(1, 0.5, 0)) * tilt *
                  Affine::rotate({0.02 * number, 0, 1}, 90 * number + 11) * Affine::scale(size),
              {{0.1 * number, 0.5, 1 - 0.1 * number}, 0.7});
    }
}

std::size_t groups_in(const TraceModel& model) {
    std::size_t groups = 0;
    for (const BoxNode& node : model.boxes)
        groups += static_cast<std::size_t>(std::ranges::count_if(node.entry, &LeafGroup::is));
    return groups;
}

TEST(LeafGroup, HoldsWhatLiesInOneBox) {
    const auto groups = [](std::size_t count, double apart) {
        Graph graph = empty_graph();
        add_fan(graph, graph.root, count, apart, Affine::rotate({1, 0.3, 0}, 40), Vec3(1));
        const auto model = traced(graph, {});
        EXPECT_EQ(model->even_triangles.size(), groups_in(*model));
        return groups_in(*model);
    };
    EXPECT_EQ(groups(1, 0), 0u);
    EXPECT_EQ(groups(3, 0), 1u);
    EXPECT_EQ(groups(4, 0.01), 1u);
    EXPECT_EQ(groups(3, 5), 0u);
    EXPECT_EQ(groups(8, 0), 2u);
}

/// Copies of itself with fans in between, some of squeezed triangles. Halves keep directions to the last bit,
/// in the general way, too.
Graph random_model(std::mt19937_64& random) {
    std::uniform_real_distribution<double> unit(-1, 1);
    const auto any = [&] { return Vec3(unit(random), unit(random), unit(random)); };
    Graph graph = empty_graph();
    const ObjectId self = graph.add({"self", {}, {}, {}, {}});
    const ObjectId cube = graph.primitive(PrimitiveKind::cube);
    for (std::size_t i = 0; i < 2 + random() % 3; ++i) {
        const ObjectId fan = graph.add({"fan" + std::to_string(i), {}, {}, {}, {}});
        const Vec3 squeezed(0.5, 0.5 + 0.4 * std::abs(unit(random)), 0.5);
        add_fan(graph, fan, 1 + random() % 6, 0.02 * static_cast<double>(random() % 2),
                Affine::rotate(any(), 180 * unit(random)), random() % 2 ? squeezed : Vec3(0.5));
        place(graph, self, fan, Affine::translate(any()) * Affine::scale(Vec3(0.5)), {{1, 1, 0}, 0.5});
    }
    for (std::size_t i = 0; i < 2 + random() % 3; ++i)
        place(graph, self, self, Affine::translate(any()) * Affine::scale(Vec3(0.5)), {{0, 1, 1}, 0.3});
    place(graph, self, cube, Affine::translate(any()) * Affine::scale(Vec3(0.125)));
    place(graph, graph.root, self, {});
    return graph;
}

/// The general way meets the triangles of a group one after the other.
TEST(LeafGroup, IsMetAsItsTrianglesAlone) {
    std::mt19937_64 random(17);
    std::uniform_real_distribution<double> unit(-1, 1);
    const auto any = [&] { return Vec3(unit(random), unit(random), unit(random)); };
    std::size_t hits = 0, groups = 0;
    for (int number = 0; number < 24; ++number) {
        SCOPED_TRACE(number);
        const Graph graph = random_model(random);
        DetailOptions options;
        options.error_px = 0;
        options.steps = 1 + number % 4;
        const auto even = traced(graph, options), general = traced(graph, options);
        ASSERT_TRUE(even->even);
        general->even = false;
        groups += groups_in(*even);
        Traversal wide(*even), narrow(*even, Instructions::portable), one_by_one(*general);
        for (int i = 0; i < 2500; ++i) {
            const Vec3 from = 1.5 * any();
            const Ray ray{from, i % 4 ? any() : 0.3 * any() - from};
            const RayRange range{i % 2 ? 1e-6 : 0.0};
            SurfaceHit a, b, c;
            const bool found = one_by_one.closest(ray, range, c);
            ASSERT_EQ(wide.closest(ray, range, a), found) << i;
            ASSERT_EQ(narrow.closest(ray, range, b), found) << i;
            ASSERT_EQ(wide.meets_any(ray, range), found) << i;
            ASSERT_EQ(narrow.meets_any(ray, range), found) << i;
            if (!found) continue;
            ++hits;
            for (const SurfaceHit& hit : {a, b}) {
                ASSERT_EQ(hit.t, c.t) << i;
                ASSERT_EQ(hit.normal, c.normal) << i;
                ASSERT_EQ(hit.rgb, c.rgb) << i;
                ASSERT_EQ(hit.node, c.node) << i;
            }
        }
        EXPECT_EQ(wide.work(), narrow.work());
    }
    EXPECT_GT(hits, 3000u);
    EXPECT_GT(groups, 50u);
}

/// Models as they are, and culled.
TEST(LeafGroup, IsMetByPacketsAsByTheirRays) {
    std::mt19937_64 random(23);
    std::uniform_real_distribution<double> unit(-1, 1);
    const auto any = [&] { return Vec3(unit(random), unit(random), unit(random)); };
    std::size_t hits = 0, groups = 0;
    for (int number = 0; number < 16; ++number) {
        SCOPED_TRACE(number);
        DetailOptions options;
        options.error_px = number % 2 ? 0 : 1;
        if (options.error_px == 0) options.steps = 2 + number % 3;
        const auto model = traced(random_model(random), options);
        groups += groups_in(*model);
        Traversal together(*model), narrow(*model, Instructions::portable), alone(*model);
        ASSERT_TRUE(together.takes_packets());
        for (int i = 0; i < 400; ++i) {
            const Vec3 from = 3.0 * any(), along = 0.5 * any() - from;
            std::array<Ray, Surfaces::most_together> rays;
            for (Ray& ray : rays)
                ray = {from, along + 0.02 * any()};
            const RayRange range{i % 2 ? 1e-6 : 0.0};
            std::array<SurfaceHit, Surfaces::most_together> seen, other;
            const std::uint32_t met = together.closest_each(rays, range, seen);
            ASSERT_EQ(narrow.closest_each(rays, range, other), met) << i;
            for (std::size_t k = 0; k < rays.size(); ++k) {
                SurfaceHit hit;
                ASSERT_EQ(alone.closest(rays[k], range, hit), (met >> k & 1) != 0) << i;
                if (!(met >> k & 1)) continue;
                ++hits;
                for (const SurfaceHit* one : {&seen[k], &other[k]}) {
                    ASSERT_EQ(hit.t, one->t) << i;
                    ASSERT_EQ(hit.normal, one->normal) << i;
                    ASSERT_EQ(hit.rgb, one->rgb) << i;
                    ASSERT_EQ(hit.node, one->node) << i;
                }
            }
        }
    }
    EXPECT_GT(hits, 5000u);
    EXPECT_GT(groups, 30u);
}

} // namespace
} // namespace graftal
