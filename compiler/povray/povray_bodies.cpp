#include "compiler/povray/povray_bodies.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>

#include "compiler/povray/literal_form.h"
#include "compiler/povray/povray_mesh.h"
#include "compiler/povray/povray_names.h"
#include "compiler/povray/regular_matrix.h"
#include "compiler/support/check.h"
#include "compiler/support/number.h"

namespace graftal {

namespace {

constexpr int body_digits = 9;
/// Primitives that are smaller than this are written with a matrix: POV-Ray loses small ones without.
constexpr double least_literal = 1e-3;

/// SDL of the canonical primitives (graph.h), up to the modifiers.
std::string canonical(PrimitiveKind kind) {
    switch (family_of(kind)) {
    case PrimitiveKind::triangle:
        return "triangle { <0,1,0>, <-0.86602540378443865,-0.5,0>, <0.86602540378443865,-0.5,0>";
    case PrimitiveKind::sphere:
        return "sphere { 0, 1";
    case PrimitiveKind::cube:
        return "box { -1, 1";
    case PrimitiveKind::plane:
        return "plane { y, 0";
    case PrimitiveKind::cylinder:
        return "cylinder { 0, y, 1";
    case PrimitiveKind::cone:
        return "cone { 0, 1, y, 0";
    case PrimitiveKind::torus:
        return "torus { 1, 0.25";
    case PrimitiveKind::frustum:
        return "cone { 0, 1, y, " + shortest(top_radius(kind));
    }
    GRAFTAL_CHECK(false, "emit_povray: unknown primitive");
}

/// POV-Ray finds it without a matrix.
bool is_large_enough(const Mat3& m) {
    return glm::length(m[0]) >= least_literal && glm::length(m[1]) >= least_literal &&
           glm::length(m[2]) >= least_literal;
}

bool write_triangle(SdlWriter& out, const Affine& a) {
    const double half = std::sqrt(3.0) / 2;
    const Vec3 top = a({0, 1, 0}), left = a({-half, -0.5, 0}), right = a({half, -0.5, 0});
    const double longest =
        std::max({glm::length(top - left), glm::length(left - right), glm::length(right - top)});
    const double area = glm::length(glm::cross(left - top, right - top));
    // Slivers too: the matrix form keeps them whole.
    if (longest < least_literal || area < least_literal * longest * longest) return false;
    out << "triangle { ";
    out.vector(top, body_digits) << ", ";
    out.vector(left, body_digits) << ", ";
    out.vector(right, body_digits);
    return true;
}

/// Writes the primitive without a matrix, up to the modifiers, where that is possible.
bool write_literal(SdlWriter& out, PrimitiveKind kind, const Affine& a) {
    const Mat3& m = a.linear;
    if (kind == PrimitiveKind::triangle) return write_triangle(out, a);
    if (!needs_no_matrix(kind, m) || !is_large_enough(m)) return false;
    switch (family_of(kind)) {
    case PrimitiveKind::sphere:
        out << "sphere { ";
        out.vector(a.translation, body_digits) << ", ";
        out.number(glm::length(m[0]), body_digits);
        return true;
    case PrimitiveKind::cube: {
        const Vec3 half = glm::abs(m[0]) + glm::abs(m[1]) + glm::abs(m[2]);
        out << "box { ";
        out.vector(a.translation - half, body_digits) << ", ";
        out.vector(a.translation + half, body_digits);
        return true;
    }
    case PrimitiveKind::cylinder:
        out << "cylinder { ";
        out.vector(a.translation, body_digits) << ", ";
        out.vector(a.translation + m[1], body_digits) << ", ";
        out.number(glm::length(m[0]), body_digits);
        return true;
    case PrimitiveKind::cone:
    case PrimitiveKind::frustum:
        out << "cone { ";
        out.vector(a.translation, body_digits) << ", ";
        out.number(glm::length(m[0]), body_digits) << ", ";
        out.vector(a.translation + m[1], body_digits) << ", ";
        out.number(top_radius(kind) * glm::length(m[0]), body_digits);
        return true;
    case PrimitiveKind::triangle:
    case PrimitiveKind::torus:
    case PrimitiveKind::plane:
        return false;
    }
    return false;
}

} // namespace

PovrayBodies::PovrayBodies(const Cut& cut, const std::string& prefix) : cut_(cut), uses_(cut.bodies.size()) {
    std::vector<bool> placed(cut.bodies.size());
    for (const PlacementGroup& group : cut.groups) {
        const std::size_t colours = cut.palettes.at(group.palette).size();
        for (const Placement& placement : group.placements) {
            GRAFTAL_CHECK(placement.body < cut.bodies.size(), "emit_povray: a placement without a body");
            placed[placement.body] = true;
            if (colours > 1) uses_[placement.body].palette = true;
        }
        for (const RunPlacements& parts : group.runs)
            for (const std::uint32_t body : parts.body)
                GRAFTAL_CHECK(body < cut.bodies.size(), "emit_povray: a part of a run without a body");
    }
    UniqueNames names(prefix + "M_");
    for (std::size_t i = 0; i < cut.bodies.size(); ++i) {
        const Mesh* const mesh = std::get_if<Mesh>(&cut.bodies[i].shape);
        if (!mesh || !placed[i]) continue;
        uses_[i].name = names.next(cut.bodies[i].name);
        triangle_count_ += mesh->triangles.size();
    }
}

bool PovrayBodies::is_plane(std::uint32_t body) const {
    const auto* const kind = std::get_if<PrimitiveKind>(&cut_.bodies[body].shape);
    return kind && *kind == PrimitiveKind::plane;
}

bool PovrayBodies::declare(SdlWriter& out, ProgressMarks& progress) const {
    for (std::size_t i = 0; i < uses_.size(); ++i) {
        if (uses_[i].name.empty()) continue;
        const Mesh& mesh = std::get<Mesh>(cut_.bodies[i].shape);
        out << "\n// " << harmless(cut_.bodies[i].name) << ": "
            << static_cast<std::uint64_t>(mesh.triangles.size()) << " triangles\n";
        if (!declare_mesh(out, uses_[i].name, mesh, uses_[i].palette, progress)) return false;
    }
    return !out.stopped();
}

void PovrayBodies::place(SdlWriter& out, std::uint32_t body, const Affine& pov_from_body,
                         std::string_view texture) const {
    if (const auto* const kind = std::get_if<PrimitiveKind>(&cut_.bodies[body].shape)) {
        if (!write_literal(out, *kind, pov_from_body)) {
            out << canonical(*kind) << " ";
            out.matrix(regular(pov_from_body));
        }
    } else {
        out << "object { " << uses_[body].name << " ";
        out.matrix(regular(pov_from_body));
    }
    if (!texture.empty()) out << "\n  " << texture;
    out << " }\n";
}

} // namespace graftal
