#include "compiler/povray/primitives.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "compiler/graph/planes.h"
#include "compiler/povray/costs.h"
#include "compiler/primitives/polygon_rings.h"
#include "compiler/primitives/tapered.h"
#include "compiler/primitives/tessellate.h"
#include "compiler/support/number.h"

namespace graftal {

namespace {

constexpr int digits = 9;
/// Primitives that are smaller than this are written with a matrix: POV-Ray loses small ones without.
constexpr double least_literal = 1e-3;
/// Lengths and angles that differ by less are equal.
constexpr double equal_share = 1e-12;

template<int bytes> double costs(const Primitive&) {
    return bytes;
}

bool at_right_angles(Vec3 a, Vec3 b) {
    return std::abs(glm::dot(a, b)) <= equal_share * glm::length(a) * glm::length(b);
}

bool equal_lengths(Vec3 a, Vec3 b) {
    return std::abs(glm::length(a) - glm::length(b)) <= equal_share * glm::length(a);
}

bool keeps_right_angles(const Mat3& m) {
    return at_right_angles(m[0], m[1]) && at_right_angles(m[0], m[2]) && at_right_angles(m[1], m[2]);
}

/// POV-Ray finds it without a matrix.
bool is_large_enough(const Mat3& m) {
    return glm::length(m[0]) >= least_literal && glm::length(m[1]) >= least_literal &&
           glm::length(m[2]) >= least_literal;
}

/// A cross-section in the plane of columns 0 and 2 stays a circle, upright on column 1.
bool keeps_round(const Mat3& m) {
    return equal_lengths(m[0], m[2]) && keeps_right_angles(m);
}

bool keeps_ball(const Mat3& m) {
    return keeps_round(m) && equal_lengths(m[0], m[1]);
}

/// Each column along one axis: boxes stay boxes.
bool keeps_axes(const Mat3& m) {
    for (int column = 0; column < 3; ++column) {
        int along = 0;
        for (int row = 0; row < 3; ++row)
            along += m[column][row] != 0;
        if (along != 1) return false;
    }
    // A singular map can send two columns along the same axis.
    return keeps_right_angles(m);
}

bool write_triangle(SdlWriter& out, const Primitive&, const Affine& a) {
    const double half = std::sqrt(3.0) / 2;
    const Vec3 top = a({0, 1, 0}), left = a({-half, -0.5, 0}), right = a({half, -0.5, 0});
    const double longest =
        std::max({glm::length(top - left), glm::length(left - right), glm::length(right - top)});
    const double area = glm::length(glm::cross(left - top, right - top));
    // Slivers too: the matrix form keeps them whole.
    if (longest < least_literal || area < least_literal * longest * longest) return false;
    out << "triangle { ";
    out.vector(top, digits) << ", ";
    out.vector(left, digits) << ", ";
    out.vector(right, digits);
    return true;
}

bool write_sphere(SdlWriter& out, const Primitive&, const Affine& a) {
    const Mat3& m = a.linear;
    if (!keeps_ball(m) || !is_large_enough(m)) return false;
    out << "sphere { ";
    out.vector(a.translation, digits) << ", ";
    out.number(glm::length(m[0]), digits);
    return true;
}

bool write_box(SdlWriter& out, const Primitive&, const Affine& a) {
    const Mat3& m = a.linear;
    if (!keeps_axes(m) || !is_large_enough(m)) return false;
    const Vec3 half = glm::abs(m[0]) + glm::abs(m[1]) + glm::abs(m[2]);
    out << "box { ";
    out.vector(a.translation - half, digits) << ", ";
    out.vector(a.translation + half, digits);
    return true;
}

/// Without a matrix: POV-Ray 3.7 bounds what a plane cuts by the wrong numbers where a matrix scales the
/// plane, and loses what lies beyond.
bool write_plane(SdlWriter& out, const Primitive&, const Affine& a) {
    const std::optional<HalfSpace> half_space = half_space_under(a);
    if (!half_space) return false;
    out << "plane { ";
    out.vector(half_space->up, digits) << ", ";
    out.number(half_space->height, digits);
    return true;
}

bool write_cylinder(SdlWriter& out, const Primitive&, const Affine& a) {
    const Mat3& m = a.linear;
    if (!keeps_round(m) || !is_large_enough(m)) return false;
    out << "cylinder { ";
    out.vector(a.translation, digits) << ", ";
    out.vector(a.translation + m[1], digits) << ", ";
    out.number(glm::length(m[0]), digits);
    return true;
}

bool write_cone(SdlWriter& out, const Primitive& primitive, const Affine& a) {
    const Mat3& m = a.linear;
    if (!keeps_round(m) || !is_large_enough(m)) return false;
    out << "cone { ";
    out.vector(a.translation, digits) << ", ";
    out.number(glm::length(m[0]), digits) << ", ";
    out.vector(a.translation + m[1], digits) << ", ";
    out.number(top_radius(primitive) * glm::length(m[0]), digits);
    return true;
}

std::string cone_text(const Primitive& primitive) {
    return "cone { 0, 1, y, " + shortest(top_radius(primitive));
}

bool any_map(const Mat3&) {
    return true;
}

std::string superellipsoid_text(const Primitive& primitive) {
    // POV-Ray's stands on the z axis.
    const std::string& name = name_of(primitive); // superellipsoid(e, n)
    const std::size_t open = name.find('(') + 1;
    return "superellipsoid { <" + name.substr(open, name.size() - open - 1) + "> rotate x*90";
}

std::string polygon_text(const Primitive& primitive) {
    std::string points;
    std::size_t count = 0;
    const auto add = [&](const PlanePoint& corner) {
        points += ", <" + shortest(corner[0]) + "," + shortest(corner[1]) + ">";
        ++count;
    };
    const PolygonRings& rings = rings_of(primitive);
    std::size_t first = 0;
    for (const std::size_t end : rings.ring_ends) {
        for (std::size_t i = first; i < end; ++i)
            add(rings.corners[i]);
        add(rings.corners[first]);
        first = end;
    }
    return "polygon { " + std::to_string(count) + points;
}

double polygon_bytes(const Primitive& primitive) {
    return 16.0 * static_cast<double>(rings_of(primitive).corners.size());
}

std::string mesh_text(const Primitive& primitive) {
    const TessellatedPrimitive& mesh = tessellated(primitive, 0);
    std::string text = "mesh2 { vertex_vectors { " + std::to_string(mesh.vertices.size());
    for (const Vec3& v : mesh.vertices)
        text += ", <" + shortest(v.x) + "," + shortest(v.y) + "," + shortest(v.z) + ">";
    if (!mesh.normals.empty()) {
        text += " } normal_vectors { " + std::to_string(mesh.normals.size());
        for (const Vec3& n : mesh.normals)
            text += ", <" + shortest(n.x) + "," + shortest(n.y) + "," + shortest(n.z) + ">";
    }
    text += " } face_indices { " + std::to_string(mesh.triangles.size());
    for (const auto& [a, b, c] : mesh.triangles)
        text += ", <" + std::to_string(a) + "," + std::to_string(b) + "," + std::to_string(c) + ">";
    return text + " }";
}

double mesh_bytes(const Primitive& primitive) {
    const TessellatedPrimitive& mesh = tessellated(primitive, 0);
    return PovrayCosts::triangle * static_cast<double>(mesh.triangles.size()) +
           PovrayCosts::vertex * static_cast<double>(mesh.vertices.size()) +
           PovrayCosts::normal * static_cast<double>(mesh.normals.size());
}

/// The table. The compiler warns of a kind without a row, and that is an error.
constexpr PovrayPrimitive row_of(PrimitiveKind kind) {
    switch (kind) {
    case PrimitiveKind::triangle:
        return {[](const Primitive&) -> std::string {
                    return "triangle { <0,1,0>, <-0.86602540378443865,-0.5,0>, <0.86602540378443865,-0.5,0>";
                },
                write_triangle, any_map, costs<400>};
    case PrimitiveKind::sphere:
        return {[](const Primitive&) -> std::string { return "sphere { 0, 1"; },
                write_sphere,
                keeps_ball,
                costs<336>,
                nullptr,
                true};
    case PrimitiveKind::cube:
        return {[](const Primitive&) -> std::string { return "box { -1, 1"; },
                write_box,
                keeps_axes,
                costs<336>,
                nullptr,
                true};
    case PrimitiveKind::plane:
        return {[](const Primitive&) -> std::string { return "plane { y, 0"; }, write_plane, any_map,
                costs<336>};
    case PrimitiveKind::cylinder:
        return {[](const Primitive&) -> std::string { return "cylinder { 0, y, 1"; }, write_cylinder,
                keeps_round, costs<640>};
    case PrimitiveKind::cone:
        return {[](const Primitive&) -> std::string { return "cone { 0, 1, y, 0"; }, write_cone, keeps_round,
                costs<640>};
    case PrimitiveKind::torus:
        return {[](const Primitive&) -> std::string { return "torus { 1, 0.25"; }, nullptr, nullptr,
                costs<336>};
    case PrimitiveKind::frustum:
        return {cone_text, write_cone, keeps_round, costs<640>};
    case PrimitiveKind::superellipsoid:
        return {superellipsoid_text, nullptr, nullptr, costs<352>, nullptr, true};
    case PrimitiveKind::polygon:
        return {polygon_text, nullptr, nullptr, costs<320>, polygon_bytes, true};
    case PrimitiveKind::bicubic_patch:
    case PrimitiveKind::sphere_sweep:
    case PrimitiveKind::limb_sweep:
    case PrimitiveKind::mesh:
        return {mesh_text, nullptr, nullptr, costs<323>, mesh_bytes, true};
    }
    return {};
}

constexpr auto table = [] {
    std::array<PovrayPrimitive, primitive_kind_count> rows{};
    for (const PrimitiveKind kind : all_primitive_kinds)
        rows[static_cast<std::size_t>(kind)] = row_of(kind);
    return rows;
}();

} // namespace

const PovrayPrimitive& povray_primitive(PrimitiveKind kind) {
    return table[static_cast<std::size_t>(kind)];
}

} // namespace graftal
