#include "compiler/detail/self_shadow.h"

#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "compiler/detail/graph/symmetry.h"
#include "compiler/detail/part_rays.h"
#include "compiler/detail/prepare.h"
#include "compiler/detail/shadow/coverage.h"
#include "compiler/graph/path.h"
#include "compiler/primitives/intersect.h"
#include "compiler/primitives/triangle_mesh.h"
#include "tests/unit/detail/models.h"

namespace graftal {
namespace {

DetailGraph with_proxies(const Graph& graph) {
    DetailGraph cut = test::cut_of(graph);
    fit_proxies(cut, find_symmetry(cut));
    return cut;
}

SelfShadows measured(DetailGraph cut, const View& view) {
    const Symmetry symmetry = find_symmetry(cut);
    return measure_self_shadows(cut, symmetry, unlimited_steps, view, true, 64);
}

/// A parallel view from above, of so many scene units on 128 pixels, in the light of one sun.
View view_of(double width, Vec3 from = {1, 2, 3}) {
    View view;
    view.size = {128, 96};
    view.camera.orthographic = true;
    view.camera.width = width;
    view.camera.direction = -glm::normalize(from);
    view.camera.location = 10.0 * glm::normalize(from);
    view.camera.right = glm::normalize(glm::cross(view.camera.direction, Vec3(0, 1, 0)));
    view.camera.up = glm::cross(view.camera.right, view.camera.direction);
    Light sun;
    sun.sun = true;
    sun.location = glm::normalize(Vec3(-2, 3, 1));
    view.lights.push_back(sun);
    return view;
}

/// Each level is four or more of the one before, down to a primitive.
Graph nested(const Primitive& leaf, const std::vector<Affine>& places, int levels) {
    Graph graph;
    ObjectId master = graph.primitive(leaf);
    for (int level = 0; level < levels; ++level) {
        Object object{"level" + std::to_string(level), {}, {}, {}, {}};
        for (const Affine& place : places)
            object.instances.push_back({master, place, {}, {}, {}});
        master = graph.add(std::move(object));
    }
    graph.root = master;
    return graph;
}

std::vector<Affine> plate() {
    std::vector<Affine> places;
    for (const double x : {-0.5, 0.5})
        for (const double z : {-0.5, 0.5})
            places.push_back({Mat3(0.5, 0, 0, 0, 1, 0, 0, 0, 0.5), {x, 0, z}});
    return places;
}

std::vector<Affine> sponge() {
    std::vector<Affine> places;
    for (int i = 0; i < 27; ++i) {
        const glm::ivec3 at(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
        if (std::abs(at.x) + std::abs(at.y) + std::abs(at.z) < 2) continue;
        places.push_back({Mat3(1.0 / 3), 2.0 / 3 * Vec3(at)});
    }
    return places;
}

/// The nearest of all leaves, one by one.
std::optional<double> nearest_leaf(const DetailGraph& cut, NodeId id, const Affine& place, const Ray& ray) {
    const DetailNode& node = cut.nodes[id];
    std::optional<double> best;
    if (node.primitive) {
        const Affine from_world = inverse(place);
        Vec3 direction = from_world.linear * ray.direction;
        const double speed = largest_entry(direction);
        PrimitiveHit hit;
        if (intersect(*node.primitive, {from_world(ray.origin), direction / speed}, {}, hit))
            best = hit.t / speed;
        return best;
    }
    for (const DetailEdge& edge : node.edges) {
        const auto t = nearest_leaf(cut, edge.child, place * edge.node_from_child, ray);
        if (t && !(best && *best < *t)) best = t;
    }
    return best;
}

TEST(PartRays, MeetWhatTheLeavesOneByOneDo) {
    const DetailGraph cut = with_proxies(nested(PrimitiveKind::cube, sponge(), 3));
    const View view = view_of(1);
    DetailOptions options;
    options.error_px = 1e-3; // nothing is culled
    const Projection projection(view, options, options.error_px, nearest_to_eye(cut));
    PartRays rays(cut, projection, unlimited_steps, 0, true);
    int hits = 0;
    for (int i = 0; i < 400; ++i) {
        const double angle = 2.4 * i, height = std::sin(1.7 * i);
        const Vec3 from = 5.0 * Vec3(std::cos(angle), height, std::sin(angle));
        const Vec3 to(0.9 * std::sin(3.1 * i), 0.9 * std::cos(2.3 * i), 0.8 * std::sin(5.9 * i));
        const Ray ray{from, glm::normalize(to - from)};
        PartHit hit;
        const std::optional<double> expected = nearest_leaf(cut, cut.root, {}, ray);
        ASSERT_EQ(rays.closest(ray, 0, hit), expected.has_value()) << i;
        EXPECT_EQ(rays.meets_any(ray, {}), expected.has_value()) << i;
        if (!expected) continue;
        ++hits;
        EXPECT_NEAR(hit.t, *expected, 1e-9) << i;
        EXPECT_EQ(hit.part, PartHit::none);
        EXPECT_LT(glm::dot(hit.normal, ray.direction), 0) << i;
        EXPECT_FALSE(rays.meets_any(ray, {0, hit.t - 1e-6})) << i;
        EXPECT_NEAR(glm::length(hit.normal), 1, 1e-9) << i;
    }
    EXPECT_GT(hits, 100);
}

/// Slivers in all directions, none of which the ray meets though it goes through their boxes: these are work.
TEST(PartRays, StepsInAMeshAreWork) {
    MeshData data;
    constexpr std::uint32_t count = 200'000;
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto at = [&](double k) {
            return Vec3(std::sin(1.1 * i + k), std::sin(2.3 * i + 2 * k), std::sin(3.7 * i + 5 * k));
        };
        const Vec3 from = at(0);
        data.vertices.insert(data.vertices.end(), {from, at(1), from + Vec3(1e-9)});
        data.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    const Primitive mesh{PrimitiveKind::mesh,
                         std::make_shared<const TriangleMesh>("slivers", std::move(data))};
    const DetailGraph cut = with_proxies(nested(mesh, {Affine()}, 1));
    const View view = view_of(1);
    const Projection projection(view, {}, 1e-3, nearest_to_eye(cut));
    PartRays rays(cut, projection, unlimited_steps, 0, true);
    PartHit hit;
    rays.closest({{-5, 0.5, 0.1}, {1, 0, 0}}, 0, hit);
    EXPECT_GT(rays.work(), 10'000u);
    EXPECT_LT(rays.work(), 30'000u);
}

// The cubes measure 1.6 pixels, and what is culled at 4 consists of several.
TEST(SelfShadow, AFlatPlateKeepsItsLight) {
    const DetailGraph cut = with_proxies(nested(PrimitiveKind::cube, plate(), 6));
    const SelfShadows shadows = measured(cut, view_of(2.5));
    for (NodeId id = 0; id < cut.nodes.size(); ++id)
        EXPECT_NEAR(shadows.share(id, 4), 1, 1.0 / 16) << cut.nodes[id].name;
}

TEST(SelfShadow, APoundSignKeepsLessTheLargerItIs) {
    const DetailGraph cut = with_proxies(test::pound_sign(3, false));
    const SelfShadows shadows = measured(cut, view_of(3));
    const double one = shadows.share(cut.root, 1), two = shadows.share(cut.root, 2);
    EXPECT_LT(one, 0.99);
    EXPECT_GT(one, 0.7);
    EXPECT_NEAR(two, one * one, 1.5 / 64); // both are rounded
    EXPECT_EQ(shadows.share(cut.root, SelfShadows::lit_as_px), 1);
    EXPECT_EQ(shadows.share_within(1, cut.root, 1.01, 4), 1) << "not culled";
    EXPECT_EQ(shadows.share_within(0.5, cut.root, 1, 4), 0.5) << "what is culled above it decides";
    EXPECT_NEAR(shadows.share_within(1, cut.root, 0.5, 4), two, 1e-9);
    const SelfShadows again = measured(cut, view_of(3));
    EXPECT_EQ(again.share(cut.root, 2), two);
}

// By other rays than those it was measured by: the mean light at 4 pixels, with the shares, and at 0.5.
TEST(SelfShadow, MakesTheMeanLightThatOfFinerParts) {
    const DetailGraph cut = with_proxies(test::pound_sign(3, false));
    const View view = view_of(3);
    const SelfShadows shadows = measured(cut, view);
    const auto light = [&](double error_px, bool shared) {
        DetailOptions options;
        const Projection projection(view, options, error_px, nearest_to_eye(cut));
        PartRays rays(cut, projection, unlimited_steps, 4, true);
        double sum = 0;
        int hits = 0;
        for (int y = 0; y < 90; ++y)
            for (int x = 0; x < 120; ++x) {
                const Vec3 across = (x - 59.7) / 40 * view.camera.right + (y - 44.7) / 40 * view.camera.up;
                const Ray ray{view.camera.location + across, view.camera.direction};
                PartHit hit;
                if (!rays.closest(ray, 0, hit)) continue;
                ++hits;
                if (glm::dot(hit.normal, ray.direction) > 0) hit.normal = -hit.normal;
                const double cosine = glm::dot(hit.normal, view.lights[0].location);
                if (!(cosine > 0) || rays.meets_any({ray(hit.t), view.lights[0].location}, {1e-5})) continue;
                sum += cosine * (shared ? shadows.share(hit.part, hit.part_px) : 1);
            }
        return sum / hits;
    };
    const double fine = light(SelfShadows::lit_as_px, false);
    EXPECT_GT(light(4, false), 1.05 * fine) << "there is something to mend";
    EXPECT_NEAR(light(4, true), fine, 0.04 * fine);
}

TEST(SelfShadow, WithoutLightsThatThrowShadowsNothingIsTaken) {
    const DetailGraph cut = with_proxies(nested(PrimitiveKind::cube, sponge(), 3));
    View view = view_of(3);
    view.lights[0].shadowless = true;
    const SelfShadows shadows = measured(cut, view);
    EXPECT_EQ(shadows.share(cut.root, 4), 1);
    EXPECT_EQ(shadows.work(), 0u);
}

// Thousands of parts in each other: rays are given up, and few are tried.
TEST(SelfShadow, WorkIsLimited) {
    Graph graph = nested(PrimitiveKind::sphere, sponge(), 2);
    Object crowd{"crowd", {}, {}, {}, {}};
    for (int i = 0; i < 30'000; ++i)
        crowd.instances.push_back({graph.root, Affine::scale(Vec3(1 - 1e-6 * i)), {}, {}, {}});
    graph.root = graph.add(std::move(crowd));
    DetailGraph cut = test::cut_of(graph);
    const SelfShadows shadows = measured(cut, view_of(3));
    EXPECT_GT(shadows.work(), 0u);
    EXPECT_LT(shadows.work(), most_self_shadow_work + 1'000'000);
}

} // namespace
} // namespace graftal
