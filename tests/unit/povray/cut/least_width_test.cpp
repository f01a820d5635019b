#include "compiler/detail/least_width.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <variant>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "compiler/analysis/bounding.h"
#include "compiler/analysis/contraction.h"
#include "compiler/detail/graph/alike_set.h"
#include "compiler/povray/cut/cut.h"
#include "tests/unit/povray/cut/cut_graph.h"

namespace graftal {
namespace {

TEST(LeastWidth, OnlyWhatHasNoAreaAndWhatIsCrushedIsWidened) {
    const Affine thin = Affine::scale({1, 0.001, 1}), line = Affine::scale({1, 0, 0}),
                 sheet = Affine::scale({1, 1, 0});
    EXPECT_EQ(half_width_needed(thin, false, 0.1), 0);
    EXPECT_EQ(half_width_needed(thin, true, 0.1), 0.1);
    EXPECT_EQ(half_width_needed(line, false, 0.1), 0.1);
    EXPECT_EQ(half_width_needed(line, false, 10), 10) << "however short it is";
    EXPECT_EQ(half_width_needed(sheet, false, 0.1), 0.1);
    EXPECT_EQ(half_width_needed(sheet, false, 10), 0.125) << "what is small stays a sheet";
    // Where nothing is culled, all is as thin as POV-Ray can draw it.
    EXPECT_EQ(half_width_needed(thin, true, 0), 0);
    EXPECT_EQ(half_width_needed(line, true, 0), 0.001);
}

TEST(LeastWidth, NoHalfAxisStaysShorterAndNoOtherChanges) {
    const Affine turn = Affine::translate({3, -2, 1}) * Affine::rotate({1, 2, 3}, 50);
    const Affine sheared{Mat3(Vec3(1, 0.2, 0), Vec3(0.9, 0.3, 0), Vec3(0, 0.1, 0.05)), Vec3(0.5)};
    for (const PrimitiveKind kind : {PrimitiveKind::sphere, PrimitiveKind::cube, PrimitiveKind::triangle,
                                     PrimitiveKind::cylinder, PrimitiveKind::cone, PrimitiveKind::torus})
        for (const Affine& place :
             {turn * Affine::scale({1, 0.3, 0.01}), turn * Affine::scale({0.02, 0.03, 0.01}),
              turn * Affine::scale({1, 0, 0}), turn * sheared}) {
            const bool round =
                kind == PrimitiveKind::sphere || kind == PrimitiveKind::cube || kind == PrimitiveKind::torus;
            const double half_width = round ? 0.1 : 0.2; // the others hold smaller balls
            const Affine wide = widened(kind, place, 0.1);
            const Vec3 before = singular_values(place.linear), after = singular_values(wide.linear);
            for (int i = 0; i < 3; ++i)
                EXPECT_NEAR(after[i], std::max(before[i], half_width), 1e-12);
            const Vec3 middle = primitive_bounds(kind).ball.centre;
            EXPECT_LT(glm::distance(wide(middle), place(middle)), 1e-12);
        }
    const Affine large = turn * Affine::scale({1, 0.3, 0.2});
    EXPECT_LT(norm(widened(PrimitiveKind::cube, large, 0.1).linear - large.linear), 1e-12);
}

// A part of a part of it lay alike, to within a cell, and both were left out.
TEST(AlikeSet, NoPartIsLeftOutForOneThatItIsAPartOf) {
    AlikeSet met;
    const auto at = [](double size) { return Affine{Mat3(size), Vec3(0.3)}; };
    EXPECT_TRUE(met.insert(1, at(1.4), 1.4));
    EXPECT_TRUE(met.insert(1, at(0.98), 0.98)) << "smaller";
    EXPECT_FALSE(met.insert(1, at(1.2), 1.2));
    EXPECT_FALSE(met.insert(1, at(0.98), 0.98));
    EXPECT_TRUE(met.insert(1, Affine{Mat3(1.4), Vec3(0.3, 0.3, 0.8)}, 1.4)) << "elsewhere";
    EXPECT_TRUE(met.insert(2, at(1.4), 1.4)) << "of another kind";
}

/// From left to right, what of the cut is drawn no farther from the line y = const than a few pixels.
std::vector<std::pair<double, double>> spans_at(const Cut& cut, double y, double px) {
    std::vector<std::pair<double, double>> spans;
    const auto add = [&](const Vec3& point, double radius) {
        if (std::abs(point.y - y) < 3 * px) spans.emplace_back(point.x - radius, point.x + radius);
    };
    for (const PlacementGroup& group : cut.groups)
        for (const Placement& placement : group.placements) {
            const Affine& place = placement.world_from_body;
            const Mesh* const mesh = std::get_if<Mesh>(&cut.bodies[placement.body].shape);
            if (!mesh) {
                add(place.translation, norm(place.linear));
                continue;
            }
            for (const auto& [a, b, c] : mesh->triangles) {
                const Vec3 p = place(mesh->vertices[a]), q = place(mesh->vertices[b]),
                           r = place(mesh->vertices[c]);
                const auto [least, most] = std::minmax({p.x, q.x, r.x});
                add({0.5 * (least + most), p.y, 0}, 0.5 * (most - least));
            }
        }
    std::ranges::sort(spans);
    return spans;
}

double area_of_meshes(const Cut& cut) {
    double area = 0;
    for (const PlacementGroup& group : cut.groups)
        for (const Placement& placement : group.placements) {
            const Mesh& mesh = std::get<Mesh>(cut.bodies[placement.body].shape);
            const Affine& place = placement.world_from_body;
            for (const auto& [a, b, c] : mesh.triangles) {
                const Vec3 p = place(mesh.vertices[a]);
                area += glm::length(glm::cross(place(mesh.vertices[b]) - p, place(mesh.vertices[c]) - p)) / 2;
            }
        }
    return area;
}

// Light comes through a sheet once, as through a polygon.
TEST(LeastWidth, MeshesOfTranslucentSheetsHaveOneFace) {
    for (const PrimitiveKind kind : {PrimitiveKind::sphere, PrimitiveKind::cube})
        for (const double thickness : {0.0, 1e-6}) {
            const auto area = [&](const Material& material) {
                Graph graph;
                graph.materials = {material};
                graph.materials[0].name = "leaf";
                graph.root = graph.add({"root", {}, {}, {}, {}});
                Instance instance;
                instance.master = graph.primitive(kind);
                instance.parent_from_child = Affine::scale({1, 1, thickness});
                instance.material = 0;
                graph.objects[graph.root].instances.push_back(instance);
                const Components components = strong_components(graph);
                const auto bounds = bound_objects(graph, components, decide_contraction(graph, components));
                View view;
                view.size = {640, 480};
                view.camera.location = Vec3(0, 0, 4);
                Diagnostics diagnostics;
                const auto cut = test::cut_graph(graph, components, bounds, view, {}, diagnostics);
                return cut ? area_of_meshes(*cut) : 0;
            };
            const double face = kind == PrimitiveKind::cube ? 4 : std::numbers::pi;
            EXPECT_NEAR(area({.translucency = 0.5}), face, 0.06) << name_of(kind) << thickness;
            EXPECT_NEAR(area({}), 2 * face, 0.06) << name_of(kind) << thickness;
            EXPECT_NEAR(area({.translucency = 0.5, .transparency = 0.5}), 2 * face, 0.06);
        }
}
// Thin maps took 1.8 GB and ended at an error of 14 pixels; then lines had gaps of forty.
TEST(LeastWidth, ThinMapsMakeThinLinesWithoutGaps) {
    for (const double thickness : {0.0, 1e-9, 1e-5, 1e-3}) {
        Graph graph;
        graph.root = graph.add({"root", {}, {}, {}, {}});
        const ObjectId self = graph.add({"self", {}, {}, {}, {}});
        const auto flat = [](Vec3 scale, Vec3 to) { return Affine::translate(to) * Affine::scale(scale); };
        for (const Affine& map :
             {flat({0.7, thickness, std::sqrt(0.7 * thickness)}, {-3, 5, 0}), flat(Vec3(0.5), {}),
              flat(Vec3(0.5), {1, 0, 0}), flat(Vec3(0.5), {0, 1, 0})})
            graph.objects[self].instances.push_back({self, map, {}, {}, {}});
        graph.objects[graph.root].instances.push_back({self, {}, {}, {}, {}});
        const Components components = strong_components(graph);
        const auto bounds = bound_objects(graph, components, decide_contraction(graph, components));
        View view;
        view.size = {640, 480};
        view.camera.location = Vec3(-4, 3, 20);
        view.camera.angle_deg = 40;
        DetailOptions options;
        options.error_px = 0.5;
        Diagnostics diagnostics;
        const auto cut = test::cut_graph(graph, components, bounds, view, options, diagnostics);
        ASSERT_TRUE(cut.has_value());
        EXPECT_LE(cut->error_px, 0.5) << thickness;
        EXPECT_LT(cut->estimated_bytes, 100'000'000u) << thickness;
        const double px = 20 * 2 * std::tan(20 * 3.14159265358979 / 180) / 640;
        double reached = -10, widest_gap = 0;
        for (const auto& [from, to] : spans_at(*cut, 5, px)) {
            widest_gap = std::max(widest_gap, from - reached);
            reached = std::max(reached, to);
        }
        EXPECT_LT(widest_gap, 0.5 * px) << thickness;
        EXPECT_GT(reached, -1.65) << thickness;
        EXPECT_LT(reached, -1.5) << thickness;
    }
}

} // namespace
} // namespace graftal
