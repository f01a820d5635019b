#include "compiler/povray/cut/overlap.h"

#include <cmath>

#include <gtest/gtest.h>

namespace graftal {
namespace {

/// 200 x 100 pixels, 20 x 10 units, seen along z.
View flat_view() {
    View view;
    view.size = {200, 100};
    view.camera.orthographic = true;
    view.camera.location = Vec3(0, 0, 50);
    view.camera.width = 20;
    return view;
}

Affine at(Vec3 place, double scale = 1) {
    return {Mat3(scale), place};
}

Cut cubes(const std::vector<Affine>& places) {
    Cut cut;
    cut.bodies.push_back({"cube", PrimitiveKind::cube});
    cut.groups.emplace_back();
    for (const Affine& place : places) {
        cut.groups[0].placements.push_back({0, place});
        cut.bounds.include(place.translation);
    }
    cut.bounds.include(Vec3(10, 10, 10));
    return cut;
}

// A cube of 2 units covers 24 / 4 = 6 square units on average: 600 of 20,000 pixels.
TEST(Overlap, AddsUpWhatPlacementsCover) {
    EXPECT_NEAR(mean_overlap(cubes({at({0, 0, 0})}), flat_view()), 0.03, 1e-9);
    EXPECT_NEAR(mean_overlap(cubes({at({0, 0, 0}), at({0, 0, -3}), at({5, 2, 0}, 0.5)}), flat_view()), 0.0675,
                1e-9);
}

TEST(Overlap, LeavesOutWhatIsOutOfThePicture) {
    EXPECT_EQ(mean_overlap(cubes({at({500, 0, 0})}), flat_view()), 0);
}

TEST(Overlap, CountsNoPlacementAsMoreThanThePicture) {
    EXPECT_NEAR(mean_overlap(cubes({at({0, 0, -1e6}, 1e5), at({0, 0, -1e6}, 1e5)}), flat_view()), 2, 1e-9);
}

// Nothing is as large as a point at the eye, and as small.
TEST(Overlap, IsANumberWhereTheEyeLiesInAPlacement) {
    View view = flat_view();
    view.camera.orthographic = false;
    EXPECT_LE(mean_overlap(cubes({at({0, 0, 50}, 0), at({0, 0, 50}, 1e-300)}), view), 2);
}

TEST(Overlap, TakesMeshesByTheirBoxes) {
    Cut cut = cubes({at({0, 0, 0})});
    Mesh mesh;
    mesh.vertices = {Vec3(-1, -1, -1), Vec3(1, 1, 1), Vec3(1, -1, 0)};
    mesh.triangles = {{0, 1, 2}};
    cut.bodies[0].shape = mesh;
    EXPECT_NEAR(mean_overlap(cut, flat_view()), 0.03, 1e-9);
}

} // namespace
} // namespace graftal
