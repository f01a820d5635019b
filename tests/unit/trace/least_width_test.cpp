// Sets without area, and what singular maps crush, are seen: a pixel wide, and in one piece where they are
// one.

#include <cmath>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "runtime/trace/traverse/traversal.h"
#include "tests/unit/trace/models.h"

namespace graftal {
namespace {

using test::empty_graph;
using test::place;
using test::traced;

DetailOptions culled_at_half_a_pixel() {
    DetailOptions options;
    options.error_px = 0.5;
    return options;
}

Affine flat_map(double a, double b, double c, double d, double e, double f) {
    const double z = std::sqrt(std::abs(a * d - b * c));
    return {Mat3(Vec3(a, c, 0), Vec3(b, d, 0), Vec3(0, 0, z)), Vec3(e, f, 0)};
}

/// The limit of maps of the plane.
Graph limit_of(const std::vector<Affine>& maps) {
    Graph graph = empty_graph();
    const ObjectId self = graph.add({"self", {}, {}, {}, {}});
    for (const Affine& map : maps)
        place(graph, self, self, map);
    place(graph, graph.root, self, {});
    return graph;
}

/// What one ray through the middle of each pixel meets.
struct Mask {
    int width = 0, height = 0;
    std::vector<bool> hit;

    bool at(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height && hit[place(x, y)]; }
    std::size_t place(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
};

double unit_px(const TraceModel& model) {
    return model.projection.pixels_per_unit({Vec3(0.0), 0});
}

Mask mask_of(const TraceModel& model) {
    const View& view = model.view;
    Traversal traversal(model);
    Mask mask{view.size.width, view.size.height, {}};
    const double tangent = std::tan(view.camera.angle_deg * 3.14159265358979 / 360);
    for (int y = 0; y < mask.height; ++y)
        for (int x = 0; x < mask.width; ++x) {
            const double u = (2 * (x + 0.5) / mask.width - 1) * tangent;
            const double v = (mask.height - 2 * (y + 0.5)) / mask.width * tangent;
            const Vec3 direction = view.camera.direction + u * view.camera.right + v * view.camera.up;
            mask.hit.push_back(traversal.meets_any({view.camera.location, direction}, {}));
        }
    return mask;
}

/// Sizes of the pieces of touching pixels.
std::vector<int> pieces_of(Mask mask) {
    std::vector<int> sizes;
    for (int y = 0; y < mask.height; ++y)
        for (int x = 0; x < mask.width; ++x) {
            if (!mask.at(x, y)) continue;
            int size = 0;
            std::vector<std::pair<int, int>> open = {{x, y}};
            mask.hit[mask.place(x, y)] = false;
            while (!open.empty()) {
                const auto [i, j] = open.back();
                open.pop_back();
                ++size;
                for (int dj = -1; dj <= 1; ++dj)
                    for (int di = -1; di <= 1; ++di) {
                        if (!mask.at(i + di, j + dj)) continue;
                        mask.hit[mask.place(i + di, j + dj)] = false;
                        open.emplace_back(i + di, j + dj);
                    }
            }
            sizes.push_back(size);
        }
    return sizes;
}

// By ellipsoids in their boxes, half a pixel large at most, 39 of 40 rays went past them.
TEST(LeastWidth, CurvesAreSeenInOnePiece) {
    const double h = std::sqrt(3.0) / 6;
    const std::vector<Affine> koch = {
        flat_map(1. / 3, 0, 0, 1. / 3, 0, 0), flat_map(1. / 6, -h, h, 1. / 6, 1. / 3, 0),
        flat_map(1. / 6, h, -h, 1. / 6, 0.5, h), flat_map(1. / 3, 0, 0, 1. / 3, 2. / 3, 0)};
    const std::vector<Affine> levy = {flat_map(0.5, -0.5, 0.5, 0.5, 0, 0),
                                      flat_map(0.5, 0.5, -0.5, 0.5, 0.5, 0.5)};
    const std::vector<Affine> gasket = {flat_map(0.5, 0, 0, 0.5, 0, 0), flat_map(0.5, 0, 0, 0.5, 0.5, 0),
                                        flat_map(0.5, 0, 0, 0.5, 0.25, std::sqrt(3.0) / 4)};
    // A fractal function: three times as high as it is wide at each third.
    const std::vector<Affine> function = {flat_map(1. / 3, 0, 0.3, 0.5, 0, 0),
                                          flat_map(1. / 3, 0, -0.4, -0.5, 1. / 3, 0.3),
                                          flat_map(1. / 3, 0, 0.1, 0.6, 2. / 3, -0.1)};
    for (const auto& [name, maps] :
         {std::pair{"koch", koch}, {"levy", levy}, {"gasket", gasket}, {"function", function}}) {
        const auto model = traced(limit_of(maps), culled_at_half_a_pixel());
        const std::vector<int> pieces = pieces_of(mask_of(*model));
        EXPECT_EQ(pieces.size(), 1u) << name;
    }
}

// Sierpinski's gasket as triangles that meet at their corners.
TEST(LeastWidth, TerminalsOfSetsWithoutAreaAreWidenedToo) {
    Graph graph = limit_of({Affine::translate({0, 0.5, 0}) * Affine::scale(Vec3(0.5)),
                            Affine::translate({-std::sqrt(3.0) / 4, -0.25, 0}) * Affine::scale(Vec3(0.5)),
                            Affine::translate({std::sqrt(3.0) / 4, -0.25, 0}) * Affine::scale(Vec3(0.5))});
    graph.objects[graph.objects[graph.root].instances[0].master].terminal =
        Instance{graph.primitive(PrimitiveKind::triangle), {}, {}, {}, {}};
    EXPECT_EQ(pieces_of(mask_of(*traced(graph, culled_at_half_a_pixel()))).size(), 1u);
}

TEST(LeastWidth, EveryGrainOfDustIsSeenAndIsNoBlob) {
    const double s = 0.02;
    std::vector<Affine> maps;
    for (const Vec3& at :
         {Vec3(0, 0, 0), Vec3(1, 0.1, 0), Vec3(0.4, 0.7, 0), Vec3(0.8, 0.9, 0), Vec3(0.1, 0.5, 0)})
        maps.push_back(Affine::translate(at) * Affine::scale({s, 0.5 * s, 0.1 * s}));
    const auto model = traced(limit_of(maps), culled_at_half_a_pixel());
    const Mask mask = mask_of(*model);
    const std::vector<int> pieces = pieces_of(mask);
    EXPECT_GE(pieces.size(), 5u);
    int sum = 0;
    for (const int size : pieces)
        sum += size;
    // 25 grains of about a pixel each, some in one another.
    EXPECT_GE(sum, 8);
    EXPECT_LE(sum, 100);
}

// The native engine drew bars of nine pixels, the store of meshes stopped at a 512th of their length.
TEST(LeastWidth, WhatIsCrushedOntoALineIsAPixelThick) {
    for (const double thickness : {0.0, 1e-9, 1e-5}) {
        Graph graph = limit_of({flat_map(0.7, 0, 0, thickness, -3, 5), flat_map(0.5, 0, 0, 0.5, 0, 0),
                                flat_map(0.5, 0, 0, 0.5, 1, 0), flat_map(0.5, 0, 0, 0.5, 0, 1)});
        const auto model = traced(graph, culled_at_half_a_pixel());
        Traversal traversal(*model);
        const double px = 1 / unit_px(*model);
        int hits = 0;
        for (int i = 0; i < 100; ++i) {
            const double x = -9 + 7 * (i + 0.5) / 100; // the line reaches from -10 to -1.6
            const auto meets = [&](double y) {
                const Vec3 target(x, y, 0);
                return traversal.meets_any(
                    {model->view.camera.location, target - model->view.camera.location}, {});
            };
            hits += meets(5) && meets(5 + 0.35 * px) && meets(5 - 0.35 * px);
            EXPECT_FALSE(meets(5 + 1.2 * px) || meets(5 - 1.2 * px)) << thickness << " " << x;
        }
        EXPECT_GE(hits, 99) << thickness;
        EXPECT_EQ(traversal.given_up(), 0u);
        EXPECT_LT(traversal.visits(), 3'000'000u) << thickness;
    }
}

// Rays took the flank of a widened cylinder for near enough, whose top is twice as far from the plane.
TEST(LeastWidth, HitsOnSetsInAPlaneAreTheNearestOrNearlySo) {
    const Affine upright = Affine::rotate({1, 0, 0}, 90), lying = Affine::rotate({1, 1, 0}, 40);
    for (const PrimitiveKind kind :
         {PrimitiveKind::cylinder, PrimitiveKind::cone, PrimitiveKind::cube, PrimitiveKind::sphere})
        for (const Affine& turned : {Affine(), upright, lying}) {
            // They nearly fill a square.
            std::vector<Affine> maps;
            for (const Vec3 at : {Vec3(0, 0, 0), Vec3(0.5, 0, 0), Vec3(0, 0.5, 0), Vec3(0.5, 0.5, 0)})
                maps.push_back(Affine::translate(at) * Affine::scale(Vec3(0.497)));
            Graph graph = limit_of(maps);
            graph.objects[graph.objects[graph.root].instances[0].master].terminal =
                Instance{graph.primitive(kind), turned * Affine::scale(Vec3(0.6)), {}, {}, {}};
            const auto model = traced(graph, culled_at_half_a_pixel());
            TraceModel patient(model->shared, model->view, model->options);
            patient.near_enough = {};
            Traversal hasty(*model), exact(patient);
            const double half_width = model->most_half_width;
            std::uint64_t hits = 0;
            for (int i = 0; i < 20; ++i) {
                const Ray ray{{0.05 + 0.045 * i, 0.93 - 0.04 * i, 5}, {0.003, 0.002, -1}};
                SurfaceHit hit, nearest;
                if (!exact.closest(ray, {}, nearest)) continue;
                ASSERT_TRUE(hasty.closest(ray, {}, hit));
                EXPECT_LE(hit.t, nearest.t + near_enough_share * half_width) << static_cast<int>(kind);
                ++hits;
            }
            EXPECT_EQ(hits, 20u);
            EXPECT_EQ(exact.given_up(), 0u);
        }
}

} // namespace
} // namespace graftal
