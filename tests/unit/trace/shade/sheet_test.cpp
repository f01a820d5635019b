// Light that comes through solids as thin as sheets, of graphs as the tracer meets them.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "runtime/trace/shade/shade.h"
#include "runtime/trace/traverse/traversal.h"
#include "tests/unit/trace/models.h"

namespace graftal {
namespace {

constexpr Material leaf{.ambient = 0, .diffuse = 0.25, .specular = 0, .translucency = 0.5};

Graph one_part(const Primitive& primitive, const Affine& place, Material material = leaf) {
    Graph graph = test::empty_graph();
    material.rgb = Rgb(1.0);
    material.name = "leaf";
    graph.materials = {material};
    test::place(graph, graph.root, graph.primitive(primitive), place);
    graph.objects[graph.root].instances.front().material = 0;
    return graph;
}

/// The light that a part shows at a point of the plane z = 0, seen from z = 6, of a sun in this direction.
Rgb seen(const Graph& graph, Vec3 sun, Vec3 at = {0.05, 0.11, 0}, bool culls = true) {
    DetailOptions options;
    if (!culls) options.error_px = 0;
    const auto model = test::traced(graph, options, Vec3(0, 0, 6));
    Traversal traversal(*model);
    View view = model->view;
    view.sky.zenith = view.sky.horizon = Rgb(0.0);
    view.lights = {{.location = sun, .sun = true, .rgb = Rgb(1.0)}};
    return Shader(view, traversal).radiance({{0, 0, 6}, glm::normalize(at - Vec3(0, 0, 6))});
}

const Vec3 in_front(0, 0.3, 1), behind(0, 0.3, -1);
const double cosine = 1 / std::sqrt(1.09);
const Affine level = Affine::rotate({1, 0, 0}, 90); ///< what lies level faces the eye

TEST(Sheets, AreOneSurfaceWhereLightComesThrough) {
    const Graph triangle = one_part(PrimitiveKind::triangle, {});
    EXPECT_NEAR(seen(triangle, behind).g, 0.5 * cosine, 1e-12);
    struct Part {
        Primitive primitive;
        Vec3 size;
    };
    for (const auto& [primitive, size] :
         {Part{PrimitiveKind::cylinder, {1, 0.002, 1}}, Part{PrimitiveKind::sphere, {1, 0.0005, 1}},
          Part{PrimitiveKind::cube, {1, 0.001, 1}}, Part{PrimitiveKind::sphere, {1, 0, 1}},
          Part{PrimitiveKind::cube, {1, 0, 1}}, Part{PrimitiveKind::cylinder, {1, 0, 1}}})
        for (const bool culls : {true, false}) {
            SCOPED_TRACE(name_of(primitive));
            const Graph sheet = one_part(primitive, level * Affine::scale(size));
            EXPECT_NEAR(seen(sheet, behind, {0.05, 0.11, 0}, culls).g, 0.5 * cosine, 1e-3);
            EXPECT_NEAR(seen(sheet, in_front, {0.05, 0.11, 0}, culls).g, 0.25 * cosine, 1e-3);
        }
}

// Blades of grass: a turtle's disc that the model with it is stretched to.
TEST(Sheets, AreStretchedDiscs) {
    for (const Vec3 size : {Vec3(0.75, 0.003, 0.05), Vec3(0.01, 0.00014, 0.5), Vec3(0.25, 0.004, 0.25)}) {
        const Graph blade = one_part(PrimitiveKind::cylinder, level * Affine::scale(size));
        EXPECT_NEAR(seen(blade, behind, {0.003, 0.011, 0}, false).g, 0.5 * cosine, 1e-3) << size.x;
        EXPECT_NEAR(seen(blade, in_front, {0.003, 0.011, 0}, false).g, 0.25 * cosine, 1e-3) << size.x;
    }
}

TEST(Sheets, LetLightThroughFarOut) {
    const Graph ball = one_part(PrimitiveKind::sphere, level * Affine::scale({1, 0.0005, 1}));
    for (const double x : {-0.99, -0.5, 0.9, 0.99})
        EXPECT_NEAR(seen(ball, behind, {x, 0, 0}).g, 0.5 * cosine, 0.01) << x;
}

TEST(Sheets, AreThin) {
    EXPECT_EQ(seen(one_part(PrimitiveKind::cylinder, level * Affine::scale({1, 0.1, 1})), behind).g, 0);
    EXPECT_EQ(seen(one_part(PrimitiveKind::sphere, {}), behind).g, 0);
    const Graph rod = one_part(PrimitiveKind::cylinder, Affine::scale({0.02, 1, 0.02}));
    EXPECT_EQ(seen(rod, behind, {0.003, 0.11, 0}).g, 0);
    EXPECT_GT(seen(rod, in_front, {0.003, 0.11, 0}).g, 0.2);
}

TEST(Sheets, StillShadeEachOther) {
    Graph graph = one_part(PrimitiveKind::cylinder, level * Affine::scale({1, 0.002, 1}));
    test::place(graph, graph.root, graph.objects[graph.root].instances.front().master,
                Affine::translate({0, 0, -0.01}) * level * Affine::scale({1, 0.002, 1}));
    graph.objects[graph.root].instances.back().material = 0;
    EXPECT_EQ(seen(graph, behind).g, 0);
    EXPECT_NEAR(seen(graph, in_front).g, 0.25 * cosine, 1e-12);
}

/// A sheet that lets all light through looks like the even sky behind it.
TEST(Sheets, AreOneSurfaceForLightThatBounces) {
    const auto light_on = [](const Primitive& primitive, const Affine& place) {
        Material material = leaf;
        material.diffuse = 0;
        material.translucency = 1;
        const auto model = test::traced(one_part(primitive, place, material), {}, Vec3(0, 0, 6));
        Traversal traversal(*model);
        View view = model->view;
        view.sky_light = SkyLight{.zenith = Rgb(1), .horizon = Rgb(1), .below = Rgb(1), .bounces = 4};
        view.shows_sky_light = true;
        Shader shader(view, traversal);
        double sum = 0;
        constexpr std::uint32_t samples = 64;
        for (std::uint32_t i = 0; i < samples; ++i) {
            SampleStream random(3, i);
            sum += shader.radiance({{0, 0, 6}, glm::normalize(Vec3(0.05, 0.11, -6))}, random).g / samples;
        }
        return sum;
    };
    EXPECT_NEAR(light_on(PrimitiveKind::triangle, {}), 1, 1e-9);
    EXPECT_NEAR(light_on(PrimitiveKind::cylinder, level * Affine::scale({1, 0.002, 1})), 1, 1e-9);
}

/// Rays that go together see the same as each by itself.
TEST(Sheets, AreMetByPacketsAsByRays) {
    for (const Primitive& primitive :
         {Primitive(PrimitiveKind::cylinder), Primitive(PrimitiveKind::sphere)}) {
        const auto model =
            test::traced(one_part(primitive, Affine::rotate({1, 2, 3}, 50) * Affine::scale({1, 0.002, 1})),
                         {}, Vec3(0, 0, 6));
        ASSERT_TRUE(model->even);
        Traversal together(*model), alone(*model);
        ASSERT_TRUE(together.takes_packets());
        std::array<Ray, Surfaces::most_together> rays;
        for (std::size_t i = 0; i < rays.size(); ++i) // two come from behind
            rays[i] = {{0.01 * static_cast<double>(i), 0.05, i < 6 ? 6 : -6}, {0, 0, i < 6 ? -1 : 1}};
        std::array<SurfaceHit, Surfaces::most_together> hits;
        const std::uint32_t met = together.closest_each(rays, {}, hits);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            SurfaceHit hit;
            ASSERT_EQ(alone.closest(rays[i], {}, hit), (met >> i & 1) != 0);
            ASSERT_TRUE(met >> i & 1);
            EXPECT_GT(glm::dot(hit.to_far_side, rays[i].direction), 0);
            EXPECT_LT(glm::distance(hit.to_far_side, hits[i].to_far_side), 1e-15) << i;
        }
    }
}

} // namespace
} // namespace graftal
