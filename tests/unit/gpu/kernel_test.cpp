// The kernel, as C++, against the native engine: rays through the same models meet the same surfaces.

#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <utility>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "runtime/trace/camera_rays.h"
#include "runtime/trace/traverse/traversal.h"
#include "tests/unit/gpu/kernel.h"
#include "tests/unit/trace/models.h"

namespace graftal {
namespace {

std::optional<FlatModel> flattened(const TraceModel& model) {
    std::string why;
    std::optional<FlatModel> flat =
        flat_model({model.prepared, model.view, model.options, model.textures, {}, {}}, why);
    EXPECT_TRUE(flat) << why;
    return flat;
}

/// Copies of itself at corners, turned and scaled unevenly, over two shapes.
Graph turned_parts() {
    Graph graph = test::empty_graph();
    const ObjectId self = graph.add({"self", {}, {}, {}, {}});
    const ObjectId cube = graph.primitive(PrimitiveKind::cube);
    const ObjectId cone = graph.primitive(PrimitiveKind::cone);
    for (const double side : {-1.0, 1.0}) {
        const Affine turn = Affine::rotate(glm::normalize(Vec3(side, 2, 1)), 0.4 * side);
        test::place(graph, self, self,
                    Affine::translate({0.6 * side, 0.7, 0.1 * side}) * turn *
                        Affine::scale(Vec3(0.55, 0.6, 0.5)),
                    {{0.9, 0.2, 0.1}, 0.3});
    }
    test::place(graph, self, cone, Affine::scale(Vec3(0.2, 0.9, 0.2)), {{0.1, 0.8, 0.2}, 0.8});
    graph.objects[self].terminal = Instance{cube, Affine::scale(Vec3(0.3)), {}, {}, {}};
    test::place(graph, graph.root, self, {});
    return graph;
}

/// Every primitive that the kernel meets by itself, side by side.
Graph all_shapes() {
    Graph graph = test::empty_graph();
    double x = 0;
    for (const PrimitiveKind kind : {PrimitiveKind::triangle, PrimitiveKind::sphere, PrimitiveKind::cube,
                                     PrimitiveKind::cylinder, PrimitiveKind::cone, PrimitiveKind::torus})
        test::place(graph, graph.root, graph.primitive(kind),
                    Affine::translate({x += 2.5, 0, 0}) *
                        Affine::rotate(glm::normalize(Vec3(1, 1, 0.3)), 0.7));
    test::place(graph, graph.root, graph.primitive(Primitive(PrimitiveKind::frustum, 40)),
                Affine::translate({x + 2.5, 0, 0}) * Affine::rotate(Vec3(1, 0, 0), 0.5));
    return graph;
}

/// Gives the root's parts a material that light comes through.
Graph made_translucent(Graph graph) {
    graph.materials = {Material{.name = "leaf", .translucency = 0.5}};
    for (Instance& instance : graph.objects[graph.root].instances)
        instance.material = 0;
    return graph;
}

struct Comparison {
    int rays = 0, hits = 0, differ = 0;
    double farthest = 0; ///< of the distances, relative
    double colour = 0;   ///< largest difference where both meet the same place
    int sheets = 0;
    double far_side = 0; ///< likewise, of the way to a sheet's other face, relative
};

Comparison compare(const TraceModel& model, int rays, std::uint32_t seed, double least_cosine = 0.9995,
                   double farthest = 2e-4) {
    const std::optional<FlatModel> flat = flattened(model);
    Comparison result;
    if (!flat) return result;
    kernel::use(*flat);
    Traversal traversal(model);
    const CameraRays camera(model.view);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(0, 1);
    for (int i = 0; i < rays; ++i) {
        const Ray ray =
            camera.through(place(random) * model.view.size.width, place(random) * model.view.size.height);
        SurfaceHit native;
        const bool met = traversal.closest(ray, {}, native);
        kernel::Hit hit{};
        const bool found = kernel::meet_first(glm::vec3(ray.origin - model.view.camera.location),
                                              glm::vec3(ray.direction), 0, kernel::FAR, false, hit);
        ++result.rays;
        result.hits += met;
        if (met != found || (met && std::abs(hit.t - native.t) > farthest * native.t)) {
            ++result.differ;
            continue;
        }
        if (!met) continue;
        result.farthest = std::max(result.farthest, std::abs(hit.t - native.t) / native.t);
        result.colour = std::max(result.colour, glm::length(Rgb(hit.rgb) - native.rgb));
        EXPECT_GT(glm::dot(Vec3(hit.normal), native.normal), least_cosine) << i;
        result.sheets += native.to_far_side != Vec3(0.0);
        const double off = glm::distance(Vec3(hit.to_far_side), native.to_far_side);
        result.far_side = std::max(result.far_side, off / (glm::length(native.to_far_side) + 1e-6));
        EXPECT_TRUE(kernel::walk(glm::vec3(ray.origin - model.view.camera.location), glm::vec3(ray.direction),
                                 0, kernel::FAR, true, hit));
    }
    return result;
}

TEST(GpuKernel, MeetsWhatTheNativeEngineMeets) {
    const Graph tetrahedron = test::tetrahedron(0.6), turned = turned_parts();
    for (const Graph* const graph : {&tetrahedron, &turned}) {
        DetailOptions options;
        const auto model = test::traced(*graph, options);
        const Comparison seen = compare(*model, 4000, 1);
        EXPECT_GT(seen.hits, 100);
        EXPECT_LE(seen.differ, seen.rays / 500);
        EXPECT_LT(seen.farthest, 1e-4);
        EXPECT_LT(seen.colour, 1e-3);
    }
}

/// Ellipsoids that stand for culled parts are far from balls.
TEST(GpuKernel, TakesTheLimitsNormals) {
    Graph graph = test::empty_graph();
    const ObjectId self = graph.add({"self", {}, {}, {}, {}});
    for (const double side : {-1.0, 1.0})
        for (const double end : {-1.0, 1.0})
            test::place(graph, self, self,
                        Affine::translate({0.5 * side, 0.05 * end, 0.5 * end}) *
                            Affine::scale(Vec3(0.55, 0.6, 0.55)));
    test::place(graph, graph.root, self, Affine::rotate(Vec3(1, 0, 0), 0.6) * Affine::scale(Vec3(2, 0.6, 2)));
    const Comparison seen = compare(*test::traced(graph, {}), 4000, 10);
    EXPECT_GT(seen.hits, 20);
    EXPECT_LE(seen.differ, 8);
}

TEST(GpuKernel, CountsLevels) {
    for (const unsigned steps : {0u, 1u, 4u}) {
        DetailOptions options;
        options.steps = steps;
        options.error_px = 0;
        const auto model = test::traced(turned_parts(), options);
        const Comparison seen = compare(*model, 2000, 2);
        EXPECT_GT(seen.hits, 40) << steps;
        EXPECT_LE(seen.differ, 4) << steps;
    }
}

TEST(GpuKernel, MeetsDustAsItIsDrawn) {
    Graph stretched = test::tetrahedron(0.4);
    const ObjectId self = stretched.objects[stretched.root].instances[0].master;
    for (Instance& part : stretched.objects[self].instances)
        part.parent_from_child = part.parent_from_child * Affine::scale(Vec3(1, 0.8, 0.6));
    const Graph even = test::tetrahedron(0.4);
    for (const Graph* const graph : std::initializer_list<const Graph*>{&even, &stretched})
        for (const bool culled : {true, false}) {
            DetailOptions options;
            if (!culled) {
                options.steps = 4;
                options.error_px = 0;
            }
            const auto model = test::traced(made_translucent(*graph), options);
            const Comparison seen = compare(*model, 4000, 6);
            EXPECT_GT(seen.hits, 10);
            EXPECT_LE(seen.differ, 4);
            EXPECT_LT(seen.far_side, 0.01);
        }
}

TEST(GpuKernel, MeetsTerminalsThatReachOutOfTheirDust) {
    Graph graph = test::tetrahedron(0.4);
    const ObjectId self = graph.objects[graph.root].instances[0].master;
    graph.objects[self].terminal = Instance{graph.primitive(PrimitiveKind::cube),
                                            Affine::translate({4, 1, 0}) * Affine::scale(Vec3(2)),
                                            {},
                                            {},
                                            {}};
    DetailOptions options;
    options.steps = 2;
    const Comparison seen = compare(*test::traced(graph, options), 4000, 23);
    EXPECT_GT(seen.hits, 50);
    EXPECT_LE(seen.differ, 4);
}

TEST(GpuKernel, MeetsAllShapes) {
    DetailOptions options;
    const auto model = test::traced(all_shapes(), options);
    const Comparison seen = compare(*model, 6000, 3);
    EXPECT_GT(seen.hits, 150);
    EXPECT_LE(seen.differ, 6);
}

/// A floor, and instances of an object with a wall of its own and a set within: planes at three levels.
Graph planes() {
    Graph graph = test::tetrahedron(0.5);
    const ObjectId set = graph.objects[graph.root].instances[0].master;
    const ObjectId plane = graph.primitive(PrimitiveKind::plane);
    const ObjectId room = graph.add({"room", {}, {}, {}, {}});
    test::place(graph, room, set, Affine::scale(Vec3(0.4)));
    test::place(graph, room, plane,
                Affine::translate({0, 0, -2}) * Affine::rotate(glm::normalize(Vec3(1, 0.2, 0.1)), 1.4),
                {{0.2, 0.4, 0.9}, 0.5});
    for (const double side : {-2.0, 2.0})
        test::place(graph, graph.root, room,
                    Affine::translate({side, 0.3, 0}) * Affine::scale(Vec3(0.7, 0.9, 0.8)),
                    {{0.9, 0.3, 0.1}, 0.2});
    for (const double height : {-1.0, -3.0, -5.0, -7.0, -9.0}) // more than one node of boxes holds
        test::place(graph, graph.root, plane, Affine::translate({0, height, 0}));
    return graph;
}

TEST(GpuKernel, MeetsPlanes) {
    const auto model = test::traced(planes(), {}, Vec3(0.5, 2, 8));
    const Comparison seen = compare(*model, 4000, 4);
    EXPECT_GT(seen.hits, 2000);
    EXPECT_LE(seen.differ, 4);
    EXPECT_LT(seen.colour, 1e-3);
}

TEST(GpuKernel, PlanesAloneAreDrawn) {
    Graph graph = test::empty_graph();
    test::place(graph, graph.root, graph.primitive(PrimitiveKind::plane), {});
    const Comparison seen = compare(*test::traced(graph, {}), 1000, 5);
    EXPECT_GT(seen.hits, 300);
    EXPECT_EQ(seen.differ, 0);
}

/// Layers of all kinds, of parts and of the world, on parts that are stretched.
TEST(GpuKernel, ShowsPatterns) {
    Graph graph = turned_parts();
    SolidPattern pattern;
    pattern.low = Rgb(0.9, 0.1, 0.1);
    pattern.high = Rgb(0.1, 0.1, 0.9);
    pattern.bump = 0.7;
    for (const PatternKind kind : {PatternKind::noise, PatternKind::ridges, PatternKind::cells,
                                   PatternKind::bands, PatternKind::rings}) {
        const bool of_world = kind == PatternKind::bands;
        pattern.layers = {
            {.kind = kind, .scale = 0.7, .of_world = of_world, .stretch = {1, 2, 0.7}, .warp = 0.5},
            {.kind = PatternKind::noise, .scale = 0.3, .octaves = 2, .share = 0.4}};
        Material material;
        material.name = "stone";
        material.rgb = Rgb(0.2, 0.8, 0.3);
        material.pattern = pattern;
        graph.materials = {material};
        graph.objects[graph.root].instances.front().material = 0;
        const auto model = test::traced(graph, {});
        const Comparison seen = compare(*model, 6000, 8);
        EXPECT_GT(seen.hits, 100);
        EXPECT_LE(seen.differ, 4);
        EXPECT_LT(seen.colour, 0.02);
    }
}

/// Images of itself in a plane, some of them slivers, to the limit.
Graph slivers_in_plane() {
    Graph graph = test::empty_graph();
    const ObjectId self = graph.add({"self", {}, {}, {}, {}});
    for (const auto& [a, b, c, d, e, f] :
         std::initializer_list<std::array<double, 6>>{{0.195, -0.488, 0.344, 0.443, 0.4431, 0.2452},
                                                      {0.462, 0.414, -0.252, 0.361, 0.2511, 0.5692},
                                                      {-0.058, -0.070, 0.453, -0.111, 0.5976, 0.0969},
                                                      {-0.035, 0.070, -0.469, -0.022, 0.4881, 0.5069},
                                                      {-0.637, 0, 0, 0.501, 0.8562, 0.2513}}) {
        const double z = std::sqrt(std::abs(a * d - b * c));
        test::place(graph, self, self, {Mat3(Vec3(a, c, 0), Vec3(b, d, 0), Vec3(0, 0, z)), Vec3(e, f, 0)});
    }
    test::place(graph, graph.root, self, {});
    return graph;
}

/// Likewise, in a model that lies in no plane.
Graph slivers_beside() {
    Graph graph = slivers_in_plane();
    test::place(graph, graph.root, graph.primitive(PrimitiveKind::cube),
                Affine::translate({3, 0, 0}) * Affine::scale(Vec3(0.1)));
    return graph;
}

/// Parts that are drawn wider than they are have the normals of their places in the world.
TEST(GpuKernel, TakesTheLimitsNormalsOfWhatIsWidened) {
    const auto model = test::traced(slivers_beside(), {}, Vec3(0.5, 0.5, 3));
    model->has_shells = false;
    const Comparison seen = compare(*model, 2000, 12, 0.99);
    EXPECT_GT(seen.hits, 60);
    EXPECT_LE(seen.differ, 4);
}

/// Boxes reach out along each axis by what the parts need there, and no ray looks for the nearest of
/// thousands of parts in a plane.
TEST(GpuKernel, PassesFewPartsOfWhatIsWidened) {
    for (const auto& [graph, most_steps_a_hit] :
         {std::pair(slivers_in_plane(), 500u), std::pair(slivers_beside(), 11000u)}) {
        const auto model = test::traced(graph, {}, Vec3(0.5, 0.5, 3));
        model->has_shells = false;
        model->near_enough = {};
        const auto flat = flattened(*model);
        ASSERT_TRUE(flat);
        kernel::use(*flat);
        kernel::steps = 0;
        Traversal exact(*model);
        const CameraRays camera(model->view);
        unsigned hits = 0, differ = 0;
        for (int y = 0; y < 480; y += 7)
            for (int x = 0; x < 640; x += 7) {
                const Ray ray = camera.through(x + 0.5, y + 0.5);
                kernel::Hit hit{};
                SurfaceHit nearest;
                const bool found = kernel::meet_first(glm::vec3(ray.origin - model->view.camera.location),
                                                      glm::vec3(ray.direction), 0, kernel::FAR, false, hit);
                const bool met = exact.closest(ray, {}, nearest);
                const double most = nearest.t + near_enough_share * model->most_half_width + 1e-5;
                hits += found;
                differ += found != met || (met && !(hit.t <= most));
            }
        EXPECT_GT(hits, 150u);
        EXPECT_LE(differ, 3u);
        EXPECT_LT(kernel::steps, most_steps_a_hit * hits);
    }
}

/// A picture of two smooth slopes: u is red and v is green.
std::shared_ptr<const Texture> slopes() {
    Texture picture;
    picture.width = picture.height = 256;
    for (int y = 0; y < 256; ++y)
        for (int x = 0; x < 256; ++x)
            picture.texels.push_back({.srgb = {static_cast<std::uint8_t>(std::abs(2 * x - 255)),
                                               static_cast<std::uint8_t>(std::abs(2 * y - 255)), 0}});
    picture.coverage = 1;
    return std::make_shared<const Texture>(picture);
}

/// The kernel meets some primitives as meshes whose points are for a picture that goes round once.
TEST(GpuKernel, RepeatsPicturesOnMeshesAsTheirMaterialsSay) {
    std::string fault;
    const auto made = [&](PrimitiveKind kind, const std::vector<double>& numbers) {
        const std::optional<Primitive> primitive = traits_of(kind).make(numbers, fault);
        EXPECT_TRUE(primitive) << fault;
        return primitive.value_or(PrimitiveKind::sphere);
    };
    for (const Primitive& primitive :
         {made(PrimitiveKind::limb_sweep, {16, 0, 0, 0, -1, 0, 0.5, 0, 1, 0, 0.4}),
          made(PrimitiveKind::superellipsoid, {0.8, 0.7}),
          made(PrimitiveKind::sphere_sweep, {0, -1, 0, 0.4, 0.2, 0, 0, 0.4, 0, 1, 0, 0.4})}) {
        Graph graph = test::empty_graph();
        Material bark;
        bark.name = "bark";
        bark.texture = "bark.png";
        bark.around = 3;
        graph.materials = {bark};
        test::place(graph, graph.root, graph.primitive(primitive), Affine::rotate(Vec3(1, 0, 0), 0.4));
        graph.objects[graph.root].instances.front().material = 0;
        const auto plain = test::traced(graph, {});
        const TraceModel model(plain->shared, plain->view, {}, {.of_material = {slopes()}, .of_ground = {}});
        const Comparison seen = compare(model, 2000, 11);
        EXPECT_GT(seen.hits, 50);
        EXPECT_LE(seen.differ, 4);
        EXPECT_LT(seen.colour, 0.05);
    }
}

TEST(GpuKernel, MeetsShapesThatSingularMapsCrush) {
    for (const PrimitiveKind kind :
         {PrimitiveKind::sphere, PrimitiveKind::cube, PrimitiveKind::cylinder, PrimitiveKind::torus})
        for (const Vec3 scale : {Vec3(1, 0, 0.7), Vec3(0, 1, 0)})
            for (const bool culled : {true, false}) {
                Graph graph = test::empty_graph();
                test::place(graph, graph.root, graph.primitive(kind),
                            Affine::rotate({1, 2, 0.5}, 50) * Affine::scale(scale) *
                                Affine::rotate({1, 1, 0.3}, 40));
                DetailOptions options;
                if (!culled) options.error_px = 0;
                const auto what = [&] {
                    return fmt::format("kind {} scale {} {} {} culled {}", int(kind), scale.x, scale.y,
                                       scale.z, culled);
                };
                const bool is_sheet = scale.x > 0; // lines have any turn about themselves
                const Comparison seen = compare(*test::traced(made_translucent(std::move(graph)), options),
                                                2000, 21, is_sheet ? 0.9 : -1.1, is_sheet ? 2e-4 : 2e-3);
                EXPECT_GT(seen.hits, is_sheet ? 50 : 1) << what();
                EXPECT_LE(seen.differ, 2) << what();
                EXPECT_LT(seen.far_side, 0.01) << what();
            }
}

/// A plant whose stem is all of it, crushed to a line or a sheet: so that is in it again and again.
Graph crushed_set(const Affine& crush) {
    Graph graph = test::empty_graph();
    const ObjectId self = graph.add({"self", {}, {}, {}, {}});
    test::place(graph, self, self, crush);
    for (const double side : {-1.0, 1.0})
        test::place(graph, self, self,
                    Affine::translate({0.2 * side, 1.2, 0}) * Affine::rotate({0.6, 0, 0.8}, 40 * side) *
                        Affine::scale(Vec3(0.6)));
    test::place(graph, graph.root, self, Affine::rotate({1, 2, 0.5}, 25));
    return graph;
}

TEST(GpuKernel, MeetsSetsThatSingularMapsCrush) {
    for (const Vec3 scale : {Vec3(0, 0.4, 0), Vec3(0.5, 0.4, 0), Vec3(0, 0.3, 0.2)})
        for (const double angle_deg : {0.0, 35.0}) {
            const Affine crush = Affine::scale(scale) * Affine::rotate({1, 0, 2}, angle_deg);
            const Comparison seen = compare(*test::traced(crushed_set(crush), {}), 4000, 22, -1.1);
            EXPECT_GT(seen.hits, 30) << angle_deg;
            EXPECT_LE(seen.differ, 4) << angle_deg;
        }
}

TEST(GpuKernel, SaysWhatItCannotDraw) {
    Graph graph = test::empty_graph();
    const ObjectId floor = graph.add({"floor", {}, {}, {}, {}});
    test::place(graph, floor, graph.primitive(PrimitiveKind::plane), {});
    test::place(graph, floor, graph.primitive(PrimitiveKind::cube), {});
    test::place(graph, graph.root, floor, Affine::scale(Vec3(1, 0, 1)));
    const auto model = test::traced(graph, {});
    std::string why;
    EXPECT_FALSE(flat_model({model->prepared, model->view, model->options, model->textures, {}, {}}, why));
    EXPECT_EQ(why, "a plane below a singular map");
}

TEST(GpuKernel, KnowsTheFarSidesOfSheets) {
    Graph leaves = turned_parts(); // with flat leaves for cones, whose holders stretch them
    const ObjectId self = leaves.objects[leaves.root].instances[0].master;
    for (const PrimitiveKind kind : {PrimitiveKind::cylinder, PrimitiveKind::sphere, PrimitiveKind::cube})
        test::place(leaves, self, leaves.primitive(kind),
                    Affine::translate({0.3, 0.3 * static_cast<double>(kind), 0.2}) *
                        Affine::rotate(glm::normalize(Vec3(1, 0.5, 0.3)), 0.8) *
                        Affine::scale(Vec3(0.3, 0.006, 0.4)));
    Graph flattened = test::empty_graph();
    const ObjectId holder = flattened.add({"holder", {}, {}, {}, {}});
    test::place(flattened, holder, flattened.primitive(PrimitiveKind::triangle),
                Affine::translate({1.8, 0, 0}));
    test::place(flattened, holder, flattened.primitive(PrimitiveKind::cube), {});
    test::place(flattened, flattened.root, holder, Affine::scale({1, 1, 0.01}));
    for (const Graph& graph : {leaves, flattened}) {
        const Comparison seen = compare(*test::traced(made_translucent(graph), {}), 6000, 9);
        EXPECT_GT(seen.sheets, 40);
        EXPECT_LT(seen.sheets, seen.hits);
        EXPECT_LE(seen.differ, 12);
        EXPECT_LT(seen.far_side, 1e-3);
    }
}

TEST(GpuKernel, HasTheRandomNumbersOfTheNativeEngine) {
    for (const std::uint64_t seed : {std::uint64_t{0}, std::uint64_t{0x123456789abcdef}})
        for (const std::uint32_t index : {0u, 1u, 77u}) {
            SampleStream native(seed, index);
            kernel::Stream stream = kernel::stream_of(
                glm::uvec2(static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)), index);
            for (int i = 0; i < 5; ++i) {
                const glm::dvec2 a = native.next();
                const glm::vec2 b = kernel::next_place(stream);
                EXPECT_NEAR(a.x, b.x, 1e-7);
                EXPECT_NEAR(a.y, b.y, 1e-7);
            }
        }
}

} // namespace
} // namespace graftal
