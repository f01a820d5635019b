#include "compiler/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "compiler/scene/backdrop.h"
#include "compiler/scene/framing.h"
#include "compiler/scene/sight.h"

namespace graftal {
namespace {

constexpr double pi = 3.14159265358979323846;

Graph model() {
    Graph graph;
    graph.root = graph.primitive(PrimitiveKind::sphere);
    return graph;
}

/// The model seen through one tint that hides it.
Graph painted(Rgb rgb) {
    Graph graph;
    Object object;
    object.name = "painted";
    object.instances.push_back({.master = graph.primitive(PrimitiveKind::sphere), .tint = {rgb, 1}});
    graph.root = graph.add(std::move(object));
    return graph;
}

struct Extent {
    double left = 1, right = 0, bottom = 1, top = 0;
};

/// Where the corners of a box lie in the picture, as shares of its width and height.
Extent extent_in_picture(const View& view, const Box& box) {
    const Camera& camera = view.camera;
    const double aspect = static_cast<double>(view.size.width) / view.size.height;
    Extent extent;
    for (int i = 0; i < 8; ++i) {
        const Vec3 p(i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y,
                     i & 4 ? box.max.z : box.min.z);
        const Vec3 sight = p - camera.location;
        const double depth = glm::dot(sight, camera.direction);
        EXPECT_GT(depth, 0);
        const double width =
            camera.orthographic ? camera.width : 2 * depth * std::tan(camera.angle_deg * pi / 360);
        const double x = 0.5 + glm::dot(sight, camera.right) / width;
        const double y = 0.5 + glm::dot(sight, camera.up) / width * aspect;
        extent.left = std::min(extent.left, x);
        extent.right = std::max(extent.right, x);
        extent.bottom = std::min(extent.bottom, y);
        extent.top = std::max(extent.top, y);
    }
    return extent;
}

void expect_orthonormal(const Camera& camera) {
    EXPECT_NEAR(glm::length(camera.right), 1, 1e-12);
    EXPECT_NEAR(glm::length(camera.up), 1, 1e-12);
    EXPECT_NEAR(glm::length(camera.direction), 1, 1e-12);
    EXPECT_NEAR(glm::length(glm::cross(camera.right, camera.up) + camera.direction), 0, 1e-12);
}

/// The tighter dimension leaves exactly the margin, both are centred.
void expect_well_framed(const View& view, const Box& box) {
    expect_orthonormal(view.camera);
    const Extent e = extent_in_picture(view, box);
    EXPECT_NEAR(std::min({e.left, 1 - e.right, e.bottom, 1 - e.top}), 0.05, 1e-9);
    EXPECT_NEAR(e.left, 1 - e.right, 1e-6);
    EXPECT_NEAR(e.bottom, 1 - e.top, 1e-6);
}

const Box unit_cube{Vec3(-1), Vec3(1)};
const Box square{{0, 0, 0}, {1, 1, 0}};

TEST(Frame, WholeBoxIsInThePictureWithTheSameMarginWhateverItsShape) {
    const ImageSize sizes[] = {{1280, 720}, {720, 1280}, {1, 1000}, {1000, 1}, {64, 64}};
    const Box boxes[] = {unit_cube,
                         square,
                         {{100, -3, 7}, {101, 40, 9}},
                         {{-1e-9, 0, 0}, {1e-9, 3e-9, 2e-9}},
                         {{-1e200, 0, 0}, {1e200, 1e200, 3e200}},
                         {{0, 0, 0}, {1, 1e-3, 1}},
                         {{0, 0, 0}, {1, 1, 0.03}},
                         {{0, 0, 0}, {1, 1, 0.2}},
                         {{0, 0, 0}, {0.1, 1, 1}},
                         {{0, 0, 0}, {100, 1, 1}},
                         {{0, 0, 0}, {0, 1, 1}},
                         {{0, 0, 0}, {1, 0, 1}}};
    for (const ImageSize size : sizes)
        for (const Box& box : boxes) {
            SCOPED_TRACE(testing::Message() << size.width << "x" << size.height << " " << box.max.x << " "
                                            << box.max.y << " " << box.max.z);
            expect_well_framed(frame(model(), box, size), box);
        }
}

TEST(Frame, SegmentsAndPointsAreSeen) {
    const Box boxes[] = {{{0, 0, 0}, {0, 5, 0}}, {{0, 0, 0}, {5, 0, 0}}, {{0, 0, 0}, {0, 0, 5}}};
    for (const Box& box : boxes) {
        SCOPED_TRACE(testing::Message() << box.max.x << " " << box.max.y << " " << box.max.z);
        const View view = frame(model(), box, {400, 300});
        expect_well_framed(view, box);
        EXPECT_NEAR(std::abs(glm::dot(view.camera.direction, glm::normalize(box.size()))), 0, 1e-12);
    }
    for (const Vec3 point : {Vec3(0.0), Vec3(3, 4, 5), Vec3(1e8, 0, 0)}) {
        const View view = frame(model(), {point, point}, {400, 300});
        expect_orthonormal(view.camera);
        const Extent e = extent_in_picture(view, {point, point});
        EXPECT_NEAR(e.left, 0.5, 1e-9);
        EXPECT_NEAR(e.top, 0.5, 1e-9);
        EXPECT_GT(view.camera.width, 0);
    }
}

TEST(Frame, FlatModelsAreSeenFaceOnWithoutPerspective) {
    struct Case {
        Box box;
        Vec3 direction, right, up;
    };
    const Case cases[] = {{square, {0, 0, -1}, {1, 0, 0}, {0, 1, 0}},
                          {{{0, 0, 0}, {0, 1, 1}}, {-1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
                          {{{0, 0, 0}, {1, 0, 1}}, {0, -1, 0}, {1, 0, 0}, {0, 0, -1}}};
    for (const Case& c : cases) {
        const Camera camera = frame(model(), c.box, {100, 100}).camera;
        EXPECT_TRUE(camera.orthographic);
        EXPECT_EQ(camera.direction, c.direction);
        EXPECT_EQ(camera.right, c.right);
        EXPECT_EQ(camera.up, c.up);
    }
}

/// Rays through the middle of a picture run along the edges of many a symmetric figure: what the bounds do
/// not know must not decide on which side of them.
TEST(Frame, NoiseOfTheBoundsMovesNoEye) {
    const double root3 = std::sqrt(3.0);
    for (const double noise : {0.0, 3e-15, -3e-13, 8e-13}) {
        const Box figure{{-root3 / 2 - noise, -0.5, 0}, {root3 / 2, 1 + noise, 0}};
        const Camera camera = frame(model(), figure, {48, 27}).camera;
        EXPECT_EQ(camera.location.x, 0) << noise;
        EXPECT_EQ(camera.location.y, 0.25) << noise;
    }
}

TEST(Frame, ModelsInSpaceAreSeenFromTheFrontRightAndAbove) {
    const Camera camera = frame(model(), unit_cube, {100, 100}).camera;
    EXPECT_FALSE(camera.orthographic);
    EXPECT_GT(camera.location.x, 0.5);
    EXPECT_GT(camera.location.y, 0.5);
    EXPECT_GT(camera.location.z, camera.location.x);
    EXPECT_GT(camera.up.y, 0.9);
    EXPECT_GT(camera.right.x, 0.8);
}

TEST(Frame, ThinPlatesTurnToTheViewerSteadily) {
    double before = 1;
    for (const double depth : {0.01, 0.08, 0.12, 0.2, 0.3, 0.5}) {
        const double facing = -frame(model(), {{0, 0, 0}, {1, 1, depth}}, {100, 100}).camera.direction.z;
        EXPECT_LE(facing, before + 1e-12) << depth;
        before = facing;
    }
    EXPECT_LT(before, 0.9);
    // What lies on the ground is looked down on, but not as a map.
    const Vec3 over_slab = frame(model(), {{0, 0, 0}, {1, 0.01, 1}}, {100, 100}).camera.direction;
    EXPECT_LT(over_slab.y, -0.6);
    EXPECT_GT(over_slab.y, -0.8);
}

TEST(Frame, CameraStatementsAreFollowedFieldByField) {
    Graph graph = model();
    graph.settings.camera = CameraSetting{.location = Vec3(0, 0, 10), .look_at = Vec3(0, 1, 0)};
    Camera camera = frame(graph, unit_cube, {100, 100}).camera;
    EXPECT_EQ(camera.location, Vec3(0, 0, 10));
    EXPECT_NEAR(glm::length(camera.direction - glm::normalize(Vec3(0, 1, -10))), 0, 1e-12);

    // The command line moves the eye, and keeps what the model looks at.
    camera = frame(graph, unit_cube, {100, 100}, {.location = Vec3(10, 1, 0), .angle_deg = 12}).camera;
    EXPECT_EQ(camera.location, Vec3(10, 1, 0));
    EXPECT_NEAR(glm::length(camera.direction - Vec3(-1, 0, 0)), 0, 1e-12);
    EXPECT_EQ(camera.angle_deg, 12);
}

TEST(Frame, TheLensIsTheModelsOrThatOfTheCommandLine) {
    Graph graph = model();
    graph.settings.camera =
        CameraSetting{.location = Vec3(0, 0, 10), .look_at = Vec3(0, 0, 0), .aperture = 0.5};
    const auto lens = [&](const CameraOverride& camera) {
        return frame(graph, unit_cube, {100, 100}, camera).lens;
    };
    EXPECT_EQ(lens({}).radius, 0.5);
    EXPECT_NEAR(lens({}).depth, 10, 1e-12);
    EXPECT_EQ(lens({.aperture = 0.2}).radius, 0.2);
    EXPECT_EQ(lens({.aperture = 0}).radius, 0); // takes the model's lens away
    EXPECT_NEAR(lens({.focus = Vec3(5, 0, 4)}).depth, 6, 1e-12);
    EXPECT_NEAR(lens({.look_at = Vec3(0, 0, 2)}).depth, 8, 1e-12); // what the camera looks at is sharp
    graph.settings.camera.reset();
    EXPECT_EQ(lens({.location = Vec3(0, 0, 10), .aperture = 0.3}).radius, 0.3);
}

TEST(Frame, LocationAloneLooksAtTheModelAndTakesItAllIn) {
    Graph graph = model();
    graph.settings.camera = CameraSetting{.location = Vec3(7, 3, 9)};
    const View view = frame(graph, unit_cube, {300, 100});
    EXPECT_EQ(view.camera.location, Vec3(7, 3, 9));
    const Extent e = extent_in_picture(view, unit_cube);
    EXPECT_NEAR(std::min({e.left, 1 - e.right, e.bottom, 1 - e.top}), 0.05, 1e-9);
}

TEST(Frame, AngleOrLookAtAloneStillTakeItAllIn) {
    for (const double angle : {0.01, 5.0, 120.0}) {
        Graph graph = model();
        graph.settings.camera = CameraSetting{.angle_deg = angle};
        const View view = frame(graph, square, {300, 200});
        EXPECT_FALSE(view.camera.orthographic);
        EXPECT_EQ(view.camera.angle_deg, angle);
        expect_well_framed(view, square);
    }
    Graph graph = model();
    graph.settings.camera = CameraSetting{.look_at = Vec3(1, 1, 1)};
    const View view = frame(graph, unit_cube, {300, 200});
    const Extent e = extent_in_picture(view, unit_cube);
    EXPECT_NEAR(std::min({e.left, 1 - e.right, e.bottom, 1 - e.top}), 0.05, 1e-9);
    EXPECT_NEAR(glm::length(glm::cross(Vec3(1, 1, 1) - view.camera.location, view.camera.direction)), 0,
                1e-9);
}

TEST(Frame, EyeInsideTheModelIsHonoured) {
    for (const Vec3 eye : {Vec3(0.0), Vec3(0.5, 0, 0)}) {
        Graph graph = model();
        graph.settings.camera = CameraSetting{.location = eye};
        const Camera camera = frame(graph, unit_cube, {300, 200}).camera;
        EXPECT_EQ(camera.location, eye);
        EXPECT_EQ(camera.angle_deg, 60);
        expect_orthonormal(camera);
    }
}

TEST(Frame, MissesWhatIsBehindOrBesideThePictureOnly) {
    const Box box{Vec3(-1), Vec3(1)};
    Camera camera; // at z = 4, along -z: 40 degrees show 1.09 to either side at the box's near face
    camera.location = {0, 0, 4};
    const auto missed = [&] { return misses(camera, box, {400, 200}); };
    EXPECT_FALSE(missed());
    for (const double x : {2.5, 2.8, 2.9, 3.5}) { // of the far face 1.82 to the left of the eye are seen
        camera.location.x = x;
        EXPECT_EQ(missed(), x > 1 + 5 * std::tan(20 * pi / 180) * (1 + 2 * 4 / 400.0)) << x;
        camera.location.x = -x;
        EXPECT_EQ(missed(), x > 1 + 5 * std::tan(20 * pi / 180) * (1 + 2 * 4 / 400.0)) << x;
    }
    camera.location = {0, 2.5, 4}; // the picture is half as high as it is wide
    EXPECT_TRUE(missed());
    camera.location = {0, -2.5, 4};
    EXPECT_TRUE(missed());
    camera.location = {0, 0, -4};
    EXPECT_TRUE(missed()) << "behind the eye";
    camera.location = {0, 0, 0.5};
    EXPECT_FALSE(missed()) << "around the eye";
    camera.location = {2, 0, 4};
    camera.orthographic = true;
    camera.width = 3;
    EXPECT_FALSE(missed());
    camera.width = 1.9;
    EXPECT_TRUE(missed());
}

TEST(Frame, UselessUpVectorsAreReplaced) {
    for (const Vec3 up : {Vec3(0, 0, 0), Vec3(0, 3, 0), Vec3(0, -1, 0), Vec3(1e300, 1e300, 0)})
        for (const double height : {10.0, -10.0}) {
            Graph graph = model();
            graph.settings.camera = CameraSetting{.location = Vec3(0, height, 0), .up = up};
            const Camera camera = frame(graph, unit_cube, {100, 100}).camera;
            expect_orthonormal(camera);
            if (up.x == 0) {
                EXPECT_NEAR(camera.right.x, 1, 1e-12);
            }
        }
    Graph graph = model();
    graph.settings.camera = CameraSetting{.up = Vec3(1, 0, 0)};
    EXPECT_EQ(frame(graph, square, {100, 100}).camera.up, Vec3(1, 0, 0));
}

TEST(Frame, AWidthMeansParallelRays) {
    Graph graph = model();
    Camera camera = frame(graph, unit_cube, {100, 100}, {.width = 0.5}).camera;
    EXPECT_TRUE(camera.orthographic);
    EXPECT_EQ(camera.width, 0.5);
    camera = frame(graph, unit_cube, {200, 100}, {.orthographic = true}).camera;
    EXPECT_TRUE(camera.orthographic);
    expect_well_framed(frame(graph, unit_cube, {200, 100}, {.orthographic = true}), unit_cube);
    graph.settings.camera = CameraSetting{.orthographic = true};
    EXPECT_FALSE(frame(graph, unit_cube, {200, 100}, {.angle_deg = 30}).camera.orthographic);
}

TEST(Frame, AViewHoldsItsWidthAndItsHeight) {
    Graph graph = model();
    graph.settings.camera = CameraSetting{.orthographic = true, .width = 4, .height = 3};
    EXPECT_EQ(frame(graph, unit_cube, {100, 100}).camera.width, 4);
    EXPECT_EQ(frame(graph, unit_cube, {200, 100}).camera.width, 6); // as high as 3
    EXPECT_EQ(frame(graph, unit_cube, {100, 100}, {.width = 2}).camera.width, 2);
}

TEST(Frame, ACameraLooksInItsDirection) {
    Graph graph = model();
    for (const Vec3 direction : {Vec3(0, 0, -2), Vec3(1, 0, 0), Vec3(0, -3, 1)}) {
        graph.settings.camera = CameraSetting{.direction = direction, .orthographic = true};
        const View view = frame(graph, unit_cube, {100, 100});
        EXPECT_LT(glm::distance(view.camera.direction, glm::normalize(direction)), 1e-12);
        expect_well_framed(view, unit_cube);
    }
    const Camera camera = frame(graph, unit_cube, {100, 100}, {.location = Vec3(0, 0, 9)}).camera;
    EXPECT_EQ(camera.direction, Vec3(0, 0, -1));
}

TEST(Frame, FlatModelsShowTheirTrueColours) {
    for (const Vec3 eye : {Vec3(0, 0, 5), Vec3(2, 1, -3)}) {
        const View view = frame(model(), square, {100, 100}, {.location = eye});
        const Material ordinary;
        ASSERT_EQ(view.lights.size(), 1u);
        EXPECT_EQ(view.lights[0].location, Vec3(0, 0, eye.z > 0 ? 1 : -1));
        EXPECT_TRUE(view.lights[0].shadowless) << "a highlight would lie over the whole figure";
        EXPECT_DOUBLE_EQ(ordinary.ambient + ordinary.diffuse * view.lights[0].rgb.g, 1);
    }
}

TEST(Frame, ModelLightsReplaceTheAutomaticOnes) {
    Graph graph = model();
    graph.settings.lights = {{.location = {0, 3e200, 4e200}, .sun = true},
                             {.location = {1, 2, 3}, .rgb = {1, 0, 0}, .shadowless = true},
                             {.location = {0, 0, 0}, .sun = true}};
    const View view = frame(graph, unit_cube, {100, 100});
    ASSERT_EQ(view.lights.size(), 3u);
    EXPECT_NEAR(glm::length(view.lights[0].location - Vec3(0, 0.6, 0.8)), 0, 1e-12);
    EXPECT_EQ(view.lights[1].location, Vec3(1, 2, 3));
    EXPECT_EQ(view.lights[1].rgb, Rgb(1, 0, 0));
    EXPECT_TRUE(view.lights[1].shadowless);
    EXPECT_EQ(view.lights[2].location, Vec3(0, 1, 0));
}

TEST(Frame, GroundTakesItsMaterialByNameAndItsOwnColour) {
    Graph graph = model();
    graph.settings.ground = GroundSetting{.height = -2};
    EXPECT_FALSE(frame(model(), unit_cube, {100, 100}).ground.has_value());
    View view = frame(graph, unit_cube, {100, 100});
    ASSERT_TRUE(view.ground.has_value());
    EXPECT_EQ(view.ground->height, -2);
    EXPECT_EQ(view.ground->material.reflection, 0);

    Material lake;
    lake.name = "lake";
    lake.reflection = 0.5;
    graph.materials.push_back(lake);
    graph.settings.ground = GroundSetting{.material = "lake", .rgb = Rgb(0, 0, 1)};
    view = frame(graph, unit_cube, {100, 100});
    EXPECT_EQ(view.ground->material.reflection, 0.5);
    EXPECT_EQ(view.ground->material.rgb, Rgb(0, 0, 1));
    EXPECT_EQ(view.ground->material.pattern, SolidPattern());

    Material& turf = graph.materials.back();
    turf.pattern.layers = {{.kind = PatternKind::noise}};
    turf.pattern.low = turf.pattern.high = Rgb(1, 0, 0);
    turf.coverage = 0.5;
    view = frame(graph, unit_cube, {100, 100});
    EXPECT_EQ(view.ground->material.pattern.low, Rgb(0, 0, 0.65)) << "about the ground's own colour";
    EXPECT_EQ(view.ground->material.pattern.high, Rgb(0, 0, 1));
    EXPECT_EQ(view.ground->material.coverage, 1) << "its picture has gone";
}

TEST(Frame, SunIsAboveTheGroundEvenIfTheEyeLooksUp) {
    Graph graph = model();
    graph.settings.ground = GroundSetting{.height = -10};
    const View view = frame(graph, unit_cube, {100, 100}, {.location = Vec3(1, -9, 1)});
    EXPECT_GT(view.lights[0].location.y, 0.2);
}

TEST(Sky, RunsFromHorizonToZenithAlongItsAxis) {
    const Sky sky{.zenith = Rgb(1, 0, 0), .horizon = Rgb(0, 0, 1), .from = 0, .to = 0.5};
    EXPECT_EQ(sky.colour({0, 1, 0}), Rgb(1, 0, 0));
    EXPECT_EQ(sky.colour({1, 0, 0}), Rgb(0, 0, 1));
    EXPECT_EQ(sky.colour({0, -1, 0}), Rgb(0, 0, 1));
    EXPECT_EQ(sky.colour(glm::normalize(Vec3(std::sqrt(15.0), 1, 0))), Rgb(0.5, 0, 0.5));
}

TEST(Sky, ModelsNameTheirOwn) {
    Graph graph = model();
    graph.settings.background = BackgroundSetting{.rgb = {0.1, 0.2, 0.3}};
    View view = frame(graph, unit_cube, {100, 100});
    EXPECT_EQ(view.sky.zenith, Rgb(0.1, 0.2, 0.3));
    EXPECT_EQ(view.sky.horizon, Rgb(0.1, 0.2, 0.3));
    graph.settings.background->horizon = Rgb(1, 1, 1);
    view = frame(graph, unit_cube, {100, 100});
    EXPECT_EQ(view.sky.horizon, Rgb(1, 1, 1));
    EXPECT_EQ(view.sky.axis, Vec3(0, 1, 0));
}

TEST(Sky, FiguresStandOutFromTheAutomaticOne) {
    EXPECT_GT(frame(painted(Rgb(0.02)), square, {100, 100}).sky.horizon.g, 0.5);
    EXPECT_LT(frame(painted(Rgb(0.9)), square, {100, 100}).sky.horizon.g, 0.3);
}

TEST(Sky, GradientSpansThePicture) {
    const View view = frame(model(), unit_cube, {100, 200});
    const double half = std::atan(2 * std::tan(view.camera.angle_deg * pi / 360));
    const Vec3 top = std::cos(half) * view.camera.direction + std::sin(half) * view.camera.up;
    const Vec3 bottom = std::cos(half) * view.camera.direction - std::sin(half) * view.camera.up;
    EXPECT_NEAR(glm::length(view.sky.colour(top) - view.sky.zenith), 0, 1e-9);
    EXPECT_NEAR(glm::length(view.sky.colour(bottom) - view.sky.horizon), 0, 1e-9);
    EXPECT_NE(view.sky.zenith, view.sky.horizon);
}

TEST(SampleColours, FollowTintsOnCyclesAndTakeTheNearestMaterial) {
    Graph graph;
    Material red, blue;
    red.rgb = {1, 0, 0};
    blue.rgb = {0, 0, 1};
    graph.materials = {red, blue};
    Object leaf;
    leaf.name = "leaf";
    leaf.instances.push_back({.master = graph.primitive(PrimitiveKind::sphere), .material = 1});
    const ObjectId leaf_id = graph.add(std::move(leaf));
    Object root;
    root.name = "root";
    root.instances.push_back({.master = leaf_id, .tint = {Rgb(0, 1, 0), 0.25}, .material = 0});
    graph.root = graph.add(std::move(root));
    for (const Rgb& colour : sample_colours(graph))
        EXPECT_EQ(colour, Rgb(0, 0.25, 0.75));

    Graph cycle;
    Object self;
    self.name = "self";
    self.instances.push_back({.master = 0, .tint = {Rgb(0.5), 0.5}});
    cycle.root = cycle.add(std::move(self));
    for (const Rgb& colour : sample_colours(cycle))
        EXPECT_NEAR(colour.g, 0.5, 1e-12);

    // The limit of a green plant had the backdrop of grey ones: its terminal alone is green.
    cycle.materials = {red};
    cycle.objects[0].instances[0].tint = {};
    cycle.objects[0].terminal = Instance{.master = cycle.primitive(PrimitiveKind::sphere), .material = 0};
    for (const Rgb& colour : sample_colours(cycle))
        EXPECT_EQ(colour, Rgb(1, 0, 0));
}

TEST(ShapedSize, SuitsTheModelAndHasAsManyPixels) {
    const ImageSize usual{1280, 720};
    const auto of = [&](const Box& box, const CameraSetting& camera = {}) {
        return shaped_size(camera, box, {}, usual);
    };
    EXPECT_EQ(of({{-1, 0, -1}, {1, 9, 1}}), (ImageSize{720, 1280}));
    EXPECT_EQ(of({{-9, 0, -1}, {9, 2, 1}}), usual);
    EXPECT_EQ(of({{0, 0, 0}, {0, 9, 0}}), (ImageSize{720, 1280})) << "of no width";
    EXPECT_EQ(of({{0, 0, 0}, {9, 0, 0}}), usual) << "of no height";
    EXPECT_EQ(of(square), (ImageSize{960, 960}));
    for (const Box& box : {unit_cube, Box{{0, 0, 0}, {2, 3, 0}}, Box{Vec3(1), Vec3(1)}}) {
        const ImageSize size = of(box);
        EXPECT_NEAR(size.width * size.height, 1280 * 720, 2000);
        EXPECT_EQ(size.width % 2 + size.height % 2, 0);
    }
    const Box tall{{0, 0, 0}, {1, 9, 0}};
    EXPECT_EQ(of(tall, {.width = 3}), usual);
    EXPECT_EQ(of(tall, {.location = Vec3(0, 0, 5), .angle_deg = 40}), usual);
    EXPECT_EQ(of(tall, {.location = Vec3(0, 0, 50)}), (ImageSize{720, 1280}));
}

TEST(PixelsPerUnit, OrthographicIsTheSameEverywhere) {
    Camera camera;
    camera.orthographic = true;
    camera.width = 4;
    EXPECT_EQ(camera.pixels_per_unit({100, 50, -7}, 800), 200);
    EXPECT_EQ(camera.pixels_per_unit({0, 0, 7}, 800), 200);
}

TEST(PixelsPerUnit, PerspectiveIsTheLargestMeasureOfALengthAcrossTheRay) {
    Camera camera;
    camera.location = {0, 0, 0};
    camera.angle_deg = 90;
    EXPECT_NEAR(camera.pixels_per_unit({0, 0, -10}, 100), 5, 1e-12);
    EXPECT_EQ(camera.pixels_per_unit({0, 0, 0}, 100), std::numeric_limits<double>::infinity());
    EXPECT_EQ(camera.pixels_per_unit({3, 4, 5}, 100), std::numeric_limits<double>::infinity());
    const Vec3 point(4, 3, -10);
    const auto picture = [](Vec3 p) { return 50.0 * Vec3(p.x / -p.z, p.y / -p.z, 0); };
    double largest = 0;
    for (int i = 0; i < 360; ++i) {
        const Vec3 sight = glm::normalize(point);
        const Vec3 u = glm::normalize(glm::cross(sight, Vec3(0, 1, 0))), v = glm::cross(u, sight);
        const Vec3 step = 1e-6 * (std::cos(i * pi / 180) * u + std::sin(i * pi / 180) * v);
        largest = std::max(largest, glm::length(picture(point + step) - picture(point)) / 1e-6);
    }
    EXPECT_NEAR(camera.pixels_per_unit(point, 100), largest, 1e-3);
}

TEST(Lights, ALampsRectangleIsLevelAndFacesWhatItLooksAt) {
    Graph graph = painted(Rgb(0.5));
    graph.settings.lights = {{.location = {0, 2, 5}, .width = 4, .height = 2, .look_at = Vec3(0, 2, 0)},
                             {.location = {1, 5, 0}, .radius = 3, .look_at = Vec3(1, 0, 0)},
                             {.location = {1, 5, 0}}};
    const View view = frame(graph, Box{Vec3(-1.0), Vec3(1.0)}, {100, 100});
    ASSERT_EQ(view.lights.size(), 3u);
    EXPECT_EQ(view.lights[0].a, Vec3(2, 0, 0));
    EXPECT_EQ(view.lights[0].b, Vec3(0, 1, 0));
    EXPECT_FALSE(view.lights[0].round);
    EXPECT_EQ(view.lights[1].a, Vec3(3, 0, 0)) << "x, where no side is level alone";
    EXPECT_EQ(glm::abs(view.lights[1].b), Vec3(0, 0, 3));
    EXPECT_TRUE(view.lights[1].round);
    EXPECT_TRUE(view.lights[0].is_area());
    EXPECT_FALSE(view.lights[2].is_area());
    EXPECT_TRUE(view.has_soft_light());
}

} // namespace
} // namespace graftal
