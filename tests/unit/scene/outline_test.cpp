#include "compiler/scene/outline.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "compiler/scene/scene.h"

namespace graftal {
namespace {

const Box unit_box{Vec3(-1), Vec3(1)};

/// Sierpinski's tetrahedron on four corners of the unit box, which is its tight box.
struct Tetrahedron {
    Graph graph;
    std::vector<ObjectBounds> bounds{{.box = unit_box}};
    std::vector<Vec3> corners = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};

    Tetrahedron() {
        Object object;
        object.name = "tetrahedron";
        for (const Vec3 corner : corners)
            object.instances.push_back(
                {.master = 0,
                 .parent_from_child = Affine::translate(0.5 * corner) * Affine::scale(Vec3(0.5))});
        graph.root = graph.add(std::move(object));
    }

    Outliner outliner() const {
        return [this](const std::vector<Vec3>& directions) { return outline(graph, bounds, directions); };
    }
};

/// Of a picture of 400x300, in its widths and heights.
struct Margins {
    double left = 1, right = 1, bottom = 1, top = 1;

    Margins(const Camera& camera, const std::vector<Vec3>& corners) {
        for (const Vec3 corner : corners) {
            const Vec3 sight = corner - camera.location;
            const double width = 2 * glm::dot(sight, camera.direction) *
                                 std::tan(camera.angle_deg * 3.14159265358979323846 / 360);
            const double x = 0.5 + glm::dot(sight, camera.right) / width;
            const double y = 0.5 + glm::dot(sight, camera.up) / width * 400 / 300;
            left = std::min(left, x);
            right = std::min(right, 1 - x);
            bottom = std::min(bottom, y);
            top = std::min(top, 1 - y);
        }
    }

    double least() const { return std::min({left, right, bottom, top}); }
};

double reach(const std::vector<Vec3>& points, Vec3 direction) {
    double most = -INFINITY;
    for (const Vec3 point : points)
        most = std::max(most, glm::dot(point, direction));
    return most;
}

TEST(Outline, HoldsTheLimitSetAndIsCloseToIt) {
    const Tetrahedron model;
    const Vec3 asked = glm::normalize(Vec3(-1, -1, -0.5));
    const std::vector<Vec3> points = outline(model.graph, model.bounds, {asked});
    EXPECT_NEAR(reach(points, asked), reach(model.corners, asked), 0.02);
    EXPECT_LT(reach(points, asked), 1.02) << "the box reaches to 1.67";
    // In directions that nobody asked for it is still no less than the set, and much closer than the box.
    for (int i = 0; i < 100; ++i) {
        const Vec3 d(std::sin(7.0 * i), std::sin(11.0 * i + 1), std::sin(13.0 * i + 2));
        EXPECT_GE(reach(points, d), reach(model.corners, d) - 1e-12);
        EXPECT_LE(reach(points, d), reach(model.corners, d) + 0.15 * glm::length(d));
    }
}

TEST(Outline, PrimitivesArePiecesToo) {
    Graph graph;
    Object object;
    object.name = "snowman";
    const ObjectId sphere = graph.primitive(PrimitiveKind::sphere);
    object.instances.push_back({.master = sphere});
    object.instances.push_back({.master = sphere, .parent_from_child = Affine::translate({0, 1.5, 0})});
    graph.root = graph.add(std::move(object));
    const std::vector<ObjectBounds> bounds = {{.box = unit_box}, {.box = {{-1, -1, -1}, {1, 2.5, 1}}}};
    const std::vector<Vec3> points = outline(graph, bounds, {{0, 1, 0}, {1, 0, 0}});
    EXPECT_EQ(points.size(), 16u);
    EXPECT_EQ(reach(points, {0, 1, 0}), 2.5);

    graph.root = sphere;
    EXPECT_EQ(outline(graph, bounds, {{0, 1, 0}}).size(), 8u);
}

TEST(Outline, PlanesDoNotCount) {
    Graph graph;
    Object object;
    object.name = "on the ground";
    object.instances.push_back({.master = graph.primitive(PrimitiveKind::plane)});
    object.instances.push_back({.master = graph.primitive(PrimitiveKind::cube)});
    graph.root = graph.add(std::move(object));
    const std::vector<ObjectBounds> bounds = {
        {.box = {}, .unbounded = true}, {.box = unit_box}, {.box = unit_box}};
    EXPECT_EQ(outline(graph, bounds, {{0, 1, 0}}).size(), 8u);
}

TEST(Outline, HostileGraphsEndSoon) {
    Graph wide;
    Object many;
    many.name = "many";
    const ObjectId cube = wide.primitive(PrimitiveKind::cube);
    for (int i = 0; i < 200'000; ++i)
        many.instances.push_back({.master = cube});
    wide.root = wide.add(std::move(many));
    EXPECT_EQ(outline(wide, {{.box = unit_box}, {.box = unit_box}}, {{0, 1, 0}}).size(), 8u);

    Graph deep;
    ObjectId below = deep.primitive(PrimitiveKind::cube);
    for (int i = 0; i < 100'000; ++i) {
        Object object;
        object.name = "link" + std::to_string(i);
        object.instances.push_back({.master = below});
        object.instances.push_back({.master = below});
        below = deep.add(std::move(object));
    }
    deep.root = below;
    const std::vector<ObjectBounds> bounds(deep.objects.size(), {.box = unit_box});
    EXPECT_LE(outline(deep, bounds, {{0, 1, 0}, {1, 0, 0}}).size(), 8u * 8000);

    Graph still; // a cycle that does not shrink (it would be refuted before)
    Object self;
    self.name = "self";
    self.instances.push_back({.master = 0});
    still.root = still.add(std::move(self));
    EXPECT_EQ(outline(still, {{.box = unit_box}}, {{0, 1, 0}}).size(), 8u);
}

TEST(Outline, FillsThePictureWithTheModelInsteadOfItsBox) {
    const Tetrahedron model;
    const View by_box = frame(model.graph, unit_box, {400, 300});
    const View view = frame(model.graph, unit_box, {400, 300}, {}, model.outliner());
    EXPECT_EQ(view.camera.direction, by_box.camera.direction);
    EXPECT_EQ(view.camera.angle_deg, by_box.camera.angle_deg);
    const Margins margins(view.camera, model.corners);
    EXPECT_GE(margins.least(), 0.05);
    EXPECT_LE(margins.least(), 0.055);
    EXPECT_NEAR(margins.left, margins.right, 0.01);
    EXPECT_NEAR(margins.bottom, margins.top, 0.01);
}

/// Long needles reach far to one side and towards the eye: steps towards equal margins led ever farther away.
TEST(Outline, ManyCornersAreAsWellCentredAsFew) {
    std::vector<Vec3> corners;
    const auto within = [](double x) { return x - std::floor(x); };
    for (int i = 0; i < 20'000; ++i) {
        const Vec3 even(within(0.819 * i), within(0.671 * i), within(0.549 * i));
        const double reach = i % 1000 == 7 ? 1 : 0.1;
        corners.push_back(reach * (2.0 * even - 1.0));
        if (reach == 1) corners.back() = glm::abs(corners.back());
    }
    const Outliner outliner = [&](const std::vector<Vec3>&) { return corners; };
    const Tetrahedron model;
    const Margins margins(frame(model.graph, unit_box, {400, 300}, {}, outliner).camera, corners);
    EXPECT_GE(margins.least(), 0.05); // the eye keeps away from the needle
    EXPECT_NEAR(margins.left, margins.right, 1e-6);
    EXPECT_NEAR(margins.bottom, margins.top, 1e-6);
}

TEST(Outline, ParallelViewsAreFilledAndCentredToo) {
    const Tetrahedron model;
    const Camera by_box = frame(model.graph, unit_box, {400, 300}, {.orthographic = true}).camera;
    const Camera camera =
        frame(model.graph, unit_box, {400, 300}, {.orthographic = true}, model.outliner()).camera;
    EXPECT_LT(camera.width, 0.95 * by_box.width);
    for (const Vec3 corner : model.corners)
        EXPECT_GT(glm::dot(corner - camera.location, camera.direction), 0);
}

} // namespace
} // namespace graftal
