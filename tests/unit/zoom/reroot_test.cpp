// A re-rooted graph draws what the old one does around the focus, at any depth.

#include "compiler/zoom/reroot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <set>

#include <boost/multiprecision/cpp_int.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "compiler/zoom/neighbourhood.h"
#include "tests/unit/detail/models.h"

namespace graftal {
namespace {

using Rational = boost::multiprecision::cpp_rational;

/// The corners' maps x -> (x + corner) / 2, each an object of its own, turned about z and moved: then no
/// number is dyadic.
Graph corner_maps(const std::vector<Vec3>& corners, const Affine& place, double ratio = 0.5) {
    Graph graph;
    graph.primitive(PrimitiveKind::triangle);
    Object root{"root", {}, {}, {}, {}};
    const std::string names[] = {"up", "left", "right", "four"};
    for (std::size_t i = 0; i < corners.size(); ++i)
        graph.add({names[i], {}, {}, {}, {}});
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Affine map{Mat3(ratio), (1 - ratio) * corners[i]};
        const Affine placed = place * map * inverse(place);
        root.instances.push_back({static_cast<ObjectId>(1 + i), {}, {}, {}, {}});
        for (std::size_t j = 0; j < corners.size(); ++j)
            graph.objects[1 + i].instances.push_back({static_cast<ObjectId>(1 + j), placed, {}, {}, {}});
    }
    graph.root = graph.add(std::move(root));
    return graph;
}

const std::vector<Vec3> triangle = {Vec3(0, 1, 0), Vec3(-0.875, -0.5, 0), Vec3(0.875, -0.5, 0)}; // dyadic
Affine askew() {
    return Affine::translate({0.3, -1.7, 0}) * Affine::rotate({0, 0, 1}, 17) * Affine::scale(Vec3(1.3));
}

std::vector<ObjectBounds> bounds_of(const Graph& graph) {
    std::vector<ObjectBounds> bounds = test::bounds_of(graph);
    bounds[0] = {{Vec3(-1, -0.5, 0), Vec3(1, 1, 0)}, {Vec3(0.0), 1.0}, false};
    return bounds;
}

View face_on(double width) {
    View view;
    view.size = {400, 300};
    view.camera.orthographic = true;
    view.camera.width = width;
    view.camera.location = Vec3(0, 0, 10);
    return view;
}

struct Tried {
    std::optional<Rerooted> rerooted;
    std::string error;
    std::string warning;
};

Tried try_zoom(const Graph& graph, const std::string& at, const std::string& zoom,
               std::optional<Vec3> look_at = {}, std::optional<unsigned> steps = {}) {
    const Components components = strong_components(graph);
    const std::vector<ObjectBounds> bounds = bounds_of(graph);
    ZoomRequest request;
    std::string problem;
    if (!at.empty()) request.at = parse_address(at, problem);
    EXPECT_EQ(problem, "");
    if (!zoom.empty()) request.zoom = Magnification::parse(zoom);
    Diagnostics diagnostics;
    Tried tried;
    std::optional<GraphPath> path;
    if (request.at) path = find_path(graph, *request.at, diagnostics);
    if (path || !request.at)
        tried.rerooted = reroot(
            {graph, components, bounds, steps, path}, request,
            [](ObjectId, unsigned) { return face_on(2.5); }, look_at, diagnostics);
    for (const Diagnostic& diagnostic : diagnostics.all())
        (diagnostic.severity == Severity::error ? tried.error : tried.warning) += diagnostic.message;
    EXPECT_EQ(tried.rerooted.has_value(), tried.error.empty());
    return tried;
}

/// The new root's parts: centres of the balls and sizes, rounded, in one order.
std::vector<std::array<double, 4>> parts(const Rerooted& rerooted, double grain = 1e-9) {
    std::vector<std::array<double, 4>> found;
    const Graph& graph = rerooted.graph;
    for (const Instance& instance : graph.objects[graph.root].instances) {
        const Vec3 centre = instance.parent_from_child(rerooted.bounds[instance.master].ball.centre);
        const double size = norm(instance.parent_from_child.linear);
        const auto rounded = [&](double x) { return std::round(x / grain) * grain + 0.0; };
        found.push_back({rounded(centre.x), rounded(centre.y), rounded(centre.z), rounded(size)});
    }
    std::sort(found.begin(), found.end());
    return found;
}

TEST(Reroot, ASmallZoomKeepsTheRoot) {
    const Graph graph = corner_maps(triangle, {});
    const Tried tried = try_zoom(graph, "(up)*", "1");
    ASSERT_TRUE(tried.rerooted);
    const Rerooted& rerooted = *tried.rerooted;
    EXPECT_EQ(rerooted.depth, 0u);
    const auto& instances = rerooted.graph.objects[rerooted.graph.root].instances;
    ASSERT_EQ(instances.size(), 1u);
    EXPECT_EQ(instances[0].master, graph.root);
    EXPECT_LT(glm::distance(instances[0].parent_from_child(Vec3(0, 1, 0)), Vec3(0.0)), 1e-15) << "the focus";
    EXPECT_EQ(rerooted.view.camera.location, Vec3(0, 0, 10));
}

TEST(Reroot, AbsorptionKeepsItsLengthInTheWorld) {
    Graph graph = corner_maps(triangle, {});
    graph.materials = {{.name = "water", .transparency = 1, .absorption = 3}, {.name = "clay"}};
    const auto at = [&](const std::string& zoom) {
        const Tried tried = try_zoom(graph, "(up)*", zoom);
        return tried.rerooted->graph.materials[0].absorption;
    };
    EXPECT_EQ(at("1"), 3);
    EXPECT_EQ(at("2^4"), 48);
    EXPECT_EQ(at("1e200"), 1e100) << "no path is that long";
    EXPECT_EQ(try_zoom(graph, "(up)*", "8").rerooted->graph.materials[1].absorption, 0);
    EXPECT_EQ(try_zoom(graph, "up.up", "").rerooted->graph.materials[0].absorption, 0) << "of no known size";
}

TEST(Reroot, PatternsOfTheWorldKeepTheirScaleThere) {
    Graph graph = corner_maps(triangle, {});
    Material stone{.name = "stone"};
    stone.pattern.layers = {{.scale = 3, .of_world = true}, {.scale = 3}};
    graph.materials = {stone};
    const auto at = [&](const std::string& address, const std::string& zoom, std::size_t layer) {
        return try_zoom(graph, address, zoom).rerooted->graph.materials[0].pattern.layers[layer].scale;
    };
    EXPECT_EQ(at("(up)*", "2^4", 0), 48);
    EXPECT_EQ(at("(up)*", "2^4", 1), 3) << "those of parts are as large as these";
    EXPECT_EQ(at("(up)*", "1e200", 0), 1e100) << "one colour";
    EXPECT_EQ(at("up.up", "", 0), 3) << "of no known size";
}

TEST(Reroot, TheSamePictureAtEveryPeriod) {
    struct Case {
        const char* at;
        int period; // of the address, in binary orders
    };
    for (const Affine& place : {Affine(), askew()})
        for (const Case& c : {Case{"(up)*", 1}, Case{"(left.right)*", 2}, Case{"left.(right)*", 1},
                              Case{"up.(left.up.right)*", 3}}) {
            SCOPED_TRACE(c.at);
            const Graph graph = corner_maps(triangle, place);
            const auto at = [&](int order) {
                const Tried tried = try_zoom(graph, c.at, "2^" + std::to_string(order * c.period));
                EXPECT_TRUE(tried.rerooted) << tried.error;
                EXPECT_EQ(tried.warning, "");
                return tried.rerooted ? parts(*tried.rerooted) : std::vector<std::array<double, 4>>();
            };
            const auto first = at(10);
            EXPECT_FALSE(first.empty());
            for (const int order : {11, 40, 110, 330, 5000})
                EXPECT_EQ(first, at(order)) << order;
        }
}

/// Where the triangles `left` and `right` touch, at (0, -1/2): both must be there, however deep.
TEST(Reroot, NeighboursAcrossTheLowestBranchAreThere) {
    for (const Affine& place : {Affine(), askew()}) {
        const Graph graph = corner_maps(triangle, place);
        const auto across = try_zoom(graph, "left.(right)*", "2^500");
        ASSERT_TRUE(across.rerooted);
        EXPECT_EQ(across.warning, "");
        const Vec3 aside = glm::normalize(place.linear * Vec3(1, 0, 0));
        bool left = false, right = false;
        for (const Instance& instance :
             across.rerooted->graph.objects[across.rerooted->graph.root].instances) {
            const Vec3 centre =
                instance.parent_from_child(across.rerooted->bounds[instance.master].ball.centre);
            left = left || glm::dot(centre, aside) < -1e-3;
            right = right || glm::dot(centre, aside) > 1e-3;
        }
        EXPECT_TRUE(left && right);
    }
}

TEST(Reroot, AnAddressGivesTheFrameOfItsObject) {
    const Graph graph = corner_maps(triangle, askew());
    const Tried shallow = try_zoom(graph, "up.left.(right.up)*3", "");
    const Tried deep = try_zoom(graph, "up.left.(right.up)*400", "");
    ASSERT_TRUE(shallow.rerooted && deep.rerooted);
    EXPECT_EQ(parts(*shallow.rerooted), parts(*deep.rerooted));
    EXPECT_GT(deep.rerooted->depth, 700u);
    EXPECT_NEAR(deep.rerooted->zoom.log2(), 801, 1e-9) << "the first step is the identity";
}

/// Exact: the corner maps of the dyadic triangle, in rational numbers.
struct ExactPiece {
    Rational x, y, size;
};

void exact_pieces(const ExactPiece& piece, const Rational& focus_x, const Rational& focus_y,
                  const Rational& reach, const Rational& least, std::set<std::pair<long, long>>& found) {
    // The hull's circle lies about the origin of the piece.
    const Rational dx = piece.x - focus_x, dy = piece.y - focus_y;
    const Rational touch = piece.size * Rational(3, 2) + reach;
    if (dx * dx + dy * dy > touch * touch) return;
    if (piece.size <= least) {
        const Rational u = dx / least * 1024, v = dy / least * 1024;
        found.emplace(std::lround(u.convert_to<double>()), std::lround(v.convert_to<double>()));
        return;
    }
    for (const Vec3& corner : triangle)
        exact_pieces({piece.x + piece.size * Rational(corner.x) / 2,
                      piece.y + piece.size * Rational(corner.y) / 2, piece.size / 2},
                     focus_x, focus_y, reach, least, found);
}

void unfolded_pieces(const Rerooted& rerooted, const Instance& instance, const Affine& parent, double reach,
                     double least, std::set<std::pair<long, long>>& found) {
    const Affine place = parent * instance.parent_from_child;
    const double size = norm(place.linear);
    const Vec3 at = place(Vec3(0.0));
    if (glm::length(at) > 1.5 * size + reach) return;
    const Object& object = rerooted.graph.objects[instance.master];
    if (size <= least * (1 + 1e-9) && object.name != "root") {
        // The piece lies where the object's own map takes it, which all its instances share.
        const Vec3 origin = place(object.instances[0].parent_from_child(Vec3(0.0)));
        found.emplace(std::lround(origin.x / (least / 2) * 1024), std::lround(origin.y / (least / 2) * 1024));
        return;
    }
    for (const Instance& part : object.instances)
        unfolded_pieces(rerooted, part, place, reach, least, found);
}

TEST(Reroot, AgreesWithExactArithmetic) {
    const Graph graph = corner_maps(triangle, {});
    const int order = 120;
    const Tried tried = try_zoom(graph, "left.(right)*", "2^" + std::to_string(order));
    ASSERT_TRUE(tried.rerooted);
    // Around (0, -1/2), exactly.
    const Rational unit = Rational(1) / boost::multiprecision::pow(boost::multiprecision::cpp_int(2), order);
    std::set<std::pair<long, long>> exact, unfolded;
    exact_pieces({0, 0, 1}, 0, Rational(-1, 2), unit, unit / 32, exact);
    for (const Instance& instance : tried.rerooted->graph.objects[tried.rerooted->graph.root].instances)
        unfolded_pieces(*tried.rerooted, instance, {}, 1.0, 1.0 / 16, unfolded);
    EXPECT_GT(exact.size(), 100u);
    std::vector<std::pair<long, long>> missing;
    // Those near the edge of the reach may be cut by the larger of two tests.
    for (const auto& piece : exact)
        if (std::hypot(piece.first, piece.second) < 0.9 * 32 * 1024 && !unfolded.count(piece))
            missing.push_back(piece);
    EXPECT_EQ(missing.size(), 0u) << "of " << exact.size();
}

TEST(Reroot, APointIsAnAddressWhereItRecurs) {
    const Affine place = askew();
    const Graph graph = corner_maps(triangle, place);
    for (const Vec3& corner : triangle) {
        const Tried deep = try_zoom(graph, "", "1e200", place(corner));
        EXPECT_TRUE(deep.rerooted) << deep.error;
        EXPECT_TRUE(!deep.rerooted || deep.rerooted->depth > 600);
    }
    const Tried generic =
        try_zoom(graph, "", "1e30", place(0.7 * triangle[0] + 0.2 * triangle[1] + 0.1 * triangle[2]));
    EXPECT_FALSE(generic.rerooted) << "its digits do not reach so deep, or it lies in a hole";
    const Tried shallow = try_zoom(graph, "", "1e3", place(0.9 * triangle[0] + 0.1 * triangle[1]));
    EXPECT_TRUE(shallow.rerooted) << shallow.error;
}

TEST(Reroot, RefusesWithAReason) {
    const Graph graph = corner_maps(triangle, {});
    EXPECT_EQ(try_zoom(graph, "(up)*", "").error,
              "an endless address is a point, and a point has no frame of its own");
    EXPECT_EQ(try_zoom(graph, "up.left", "1e30").error,
              "the address ends after 2 steps, before the zoom does");
    EXPECT_EQ(try_zoom(graph, "(up)*", "2^50", {}, 20u).error,
              "the address is 21 levels deep, but --steps ends the model after 20");
    EXPECT_EQ(try_zoom(graph, "up.up.up", "", {}, 2u).error,
              "the address is 3 levels deep, but --steps ends the model after 2");

    Graph flat = corner_maps(triangle, {});
    for (Instance& instance : flat.objects[1].instances)
        instance.parent_from_child.linear[0] = Vec3(0.0);
    EXPECT_NE(try_zoom(flat, "(up)*", "2^20").error.find("leads through"), std::string::npos);

    Graph affine = corner_maps(triangle, {});
    for (ObjectId id = 1; id <= 3; ++id)
        for (Instance& instance : affine.objects[id].instances)
            instance.parent_from_child.linear = Mat3(0.5, 0, 0, 0, 0.25, 0, 0, 0, 0.5);
    EXPECT_TRUE(try_zoom(affine, "(up)*", "2^3").rerooted);
    EXPECT_NE(try_zoom(affine, "(up)*", "2^100").error, "");
}

/// Levels that the way down has used up are not drawn again.
TEST(Reroot, StepsCountFromTheOldRoot) {
    const Graph graph = corner_maps(triangle, {});
    const Tried tried = try_zoom(graph, "(up)*10", "", {}, 14u);
    ASSERT_TRUE(tried.rerooted) << tried.error;
    EXPECT_EQ(tried.rerooted->steps, 15u);
    const Graph& rerooted = tried.rerooted->graph;
    std::uint32_t most = 0;
    for (const Instance& instance : rerooted.objects[rerooted.root].instances) {
        ASSERT_NE(instance.levels, levels_of_master);
        EXPECT_LE(instance.levels, 15u);
        most = std::max(most, instance.levels);
    }
    EXPECT_GE(most, 8u);
}

/// A picture shows an object in the object's own frame: the world turns the other way.
TEST(Reroot, TheSkysPictureStaysInTheWorld) {
    const Affine world_from_part = Affine::rotate({0, 0, 1}, 90) * Affine::scale(Vec3(0.5));
    Graph graph;
    graph.primitive(PrimitiveKind::triangle);
    Object part{"part", {}, {}, {}, {}}, root{"root", {}, {}, {}, {}};
    part.instances.push_back({0, {}, {}, {}, {}});
    root.instances.push_back({graph.add(std::move(part)), world_from_part, {}, {}, {}});
    graph.root = graph.add(std::move(root));
    graph.settings.sky.emplace();
    const Components components = strong_components(graph);
    const std::vector<ObjectBounds> bounds = bounds_of(graph);
    const auto picture = std::make_shared<const SkyPicture>(
        2, 2, std::vector<SkyPicture::Texel>{{1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}});
    const FrameObject frame = [&](ObjectId, unsigned) {
        View view = face_on(2.5);
        view.sky_light.emplace();
        view.sky_light->picture = picture;
        return view;
    };
    Diagnostics diagnostics;
    std::string problem;
    ZoomRequest request;
    request.at = parse_address("part", problem);
    const std::optional<GraphPath> at = find_path(graph, *request.at, diagnostics);
    const std::optional<Rerooted> rerooted =
        reroot({graph, components, bounds, {}, at}, request, frame, {}, diagnostics);
    ASSERT_TRUE(rerooted);
    const SkyLight& sky = *rerooted->view.sky_light;
    const Mat3 part_from_world = Affine::rotate({0, 0, 1}, -90).linear;
    for (const Vec3 direction : {Vec3(1, 0, 0), Vec3(0, 0.6, 0.8), Vec3(-0.6, 0, 0.8), Vec3(0, -1, 0)})
        EXPECT_NEAR(sky.radiance(part_from_world * direction).r, picture->radiance(direction).r, 1e-9);
}

TEST(Reroot, LightsGroundAndHazeFollow) {
    const Graph graph = corner_maps(triangle, {});
    const Components components = strong_components(graph);
    const std::vector<ObjectBounds> bounds = bounds_of(graph);
    const FrameObject frame = [](ObjectId, unsigned) {
        View view = face_on(2.5);
        view.lights = {{.location = Vec3(0, 3, 0), .a = Vec3(0, 0, 0.5), .b = Vec3(0.25, 0, 0)},
                       {.location = Vec3(0, 1, 0), .sun = true},
                       {.location = Vec3(0, 1, 0), .a = Vec3(0, 0, 0.5)}};
        view.ground = Ground{1.0, {}};
        view.haze = Haze{.distance = 1e-97, .height = std::numeric_limits<double>::infinity()};
        view.lens = {0.5, 10};
        return view;
    };
    Diagnostics diagnostics;
    const auto zoomed = [&](const char* zoom) {
        ZoomRequest request;
        std::string problem;
        request.at = parse_address("(up)*", problem);
        request.zoom = Magnification::parse(zoom);
        const std::optional<GraphPath> at = find_path(graph, *request.at, diagnostics);
        return reroot({graph, components, bounds, {}, at}, request, frame, {}, diagnostics)->view;
    };
    EXPECT_EQ(zoomed("4").lights[0].location, Vec3(0, 8, 0));
    EXPECT_FALSE(zoomed("4").lights[0].sun);
    EXPECT_EQ(zoomed("4").lights[0].a, Vec3(0, 0, 2));
    EXPECT_EQ(zoomed("4").lights[0].b, Vec3(1, 0, 0));
    EXPECT_FALSE(zoomed("1e100").lights[0].is_area());
    EXPECT_TRUE(zoomed("1e100").lights[0].sun);
    EXPECT_LT(glm::distance(zoomed("1e100").lights[0].location, Vec3(0, 1, 0)), 1e-12);
    EXPECT_TRUE(zoomed("1e100").lights[1].sun);
    for (const char* const zoom : {"4", "1e100", "1e400"}) {
        const Light at_focus = zoomed(zoom).lights[2];
        EXPECT_EQ(at_focus.location, Vec3(0.0)) << zoom;
        EXPECT_FALSE(at_focus.sun) << zoom;
        EXPECT_TRUE(std::isfinite(at_focus.a.z)) << zoom;
        EXPECT_GE(at_focus.a.z, 2) << zoom;
        EXPECT_EQ(at_focus.b, Vec3(0.0)) << zoom;
    }
    EXPECT_EQ(zoomed("4").lens.radius, 0) << "its depth was that of the camera before";
    ASSERT_TRUE(zoomed("1e100").ground) << "the focus lies on it";
    EXPECT_NEAR(zoomed("4").ground->height, 0, 1e-12);
    ASSERT_TRUE(zoomed("1e100").haze) << "an even one, whose base lies far below in this picture";
    EXPECT_NEAR(zoomed("1e100").haze->left_after(Vec3(0, 5, 0), Vec3(1, 0, 0), 1000), std::exp(-1), 1e-12);
}

TEST(Reroot, TheGroundStaysInTheWorld) {
    const Graph graph = corner_maps(triangle, {});
    const Components components = strong_components(graph);
    const std::vector<ObjectBounds> bounds = bounds_of(graph);
    const FrameObject frame = [](ObjectId, unsigned) {
        View view = face_on(2.5);
        view.ground = Ground{-0.5, {.name = "grass"}};
        return view;
    };
    Diagnostics diagnostics;
    ZoomRequest request;
    std::string problem;
    // In the frame of the second `left`, half as large and about (-7/8, -1/2) / 2.
    request.at = parse_address("left.left", problem);
    const std::optional<GraphPath> at = find_path(graph, *request.at, diagnostics);
    const auto rerooted = reroot({graph, components, bounds, {}, at}, request, frame, {}, diagnostics);
    ASSERT_TRUE(rerooted);
    EXPECT_FALSE(rerooted->view.ground);
    const Instance& plane = rerooted->graph.objects[rerooted->graph.root].instances.back();
    EXPECT_EQ(rerooted->graph.objects[plane.master].primitive, PrimitiveKind::plane);
    EXPECT_NEAR(plane.parent_from_child.translation.y, 2 * (-0.5 + 0.25), 1e-12);
    ASSERT_TRUE(plane.material);
    EXPECT_EQ(rerooted->graph.materials[*plane.material].name, "ground");
    EXPECT_EQ(rerooted->bounds.size(), rerooted->graph.objects.size());
}

/// A part of itself, beside many that each step down leaves far behind.
TEST(Reroot, EachStepDownMayLookAtAsManyPieces) {
    constexpr std::size_t siblings = 4000, steps = 510;
    static_assert(siblings * steps > Neighbourhood::most_looks);
    Graph graph;
    const ObjectId sphere = graph.primitive(PrimitiveKind::sphere);
    Object root{"root", {}, {}, {}, {}};
    root.instances.push_back({1, Affine::scale(Vec3(0.5)), {}, {}, {}});
    root.instances.resize(1 + siblings, {sphere, Affine::translate({100, 0, 0}), {}, {}, {}});
    graph.root = graph.add(std::move(root));
    const Components components = strong_components(graph);
    const std::vector<ObjectBounds> bounds = {
        {{Vec3(-1.0), Vec3(1.0)}, {Vec3(0.0), 1}, false},
        {{Vec3(-101, -1, -1), Vec3(101, 1, 1)}, {Vec3(0.0), 102}, false}};
    StageWork work;
    Control control;
    control.work = &work;
    WorkMeter meter(control, "frame", 1000, 1);
    Neighbourhood around(graph, components, bounds, {}, meter);
    for (std::size_t i = 0; i < steps; ++i)
        ASSERT_EQ(around.descend(0, Vec3(0.0), 1), Neighbourhood::Outcome::done) << i;
    EXPECT_FALSE(around.looked_too_often());
    meter.charge(0);
    EXPECT_EQ(work.seconds(), static_cast<double>(steps * (1 + siblings))) << "each is counted";
    EXPECT_LT(around.ways().steps(), 75'000u) << "ways of parts far behind are forgotten";
    around.ways().set_ends({around.own().way});
    EXPECT_EQ(around.ways().path(0), std::vector<GraphStep>(steps, {1, 0}));
}

TEST(NearWays, KeepOnlyTheirOwnSteps) {
    NearWays ways;
    const std::uint32_t first = ways.add(NearWays::root, {0, 1}), dead = ways.add(first, {1, 7});
    std::uint32_t last = ways.add(first, {1, 2}), root = NearWays::root, other = ways.add(last, {2, 3});
    ways.add(dead, {7, 7});
    ways.keep_only({&last, &root, &other});
    EXPECT_EQ(ways.steps(), 3u);
    EXPECT_EQ(root, NearWays::root);
    ways.set_ends({other, last, root});
    EXPECT_EQ(ways.path(0), (std::vector<GraphStep>{{0, 1}, {1, 2}, {2, 3}}));
    EXPECT_EQ(ways.path(1), (std::vector<GraphStep>{{0, 1}, {1, 2}}));
    EXPECT_TRUE(ways.path(2).empty());
}

} // namespace
} // namespace graftal
