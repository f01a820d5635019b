#include "compiler/povray/povray_costs.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include <glm/geometric.hpp>

namespace graftal {

namespace {

/// Whether the primitive stays of its kind: emit writes it without a matrix then.
bool stays_of_its_kind(PrimitiveKind kind, const Mat3& m) {
    constexpr double slack = 1e-9;
    const auto upright = [&](int i, int j) {
        return std::abs(glm::dot(m[i], m[j])) <= slack * glm::length(m[i]) * glm::length(m[j]);
    };
    const auto equal = [&](int i, int j) {
        return std::abs(glm::length(m[i]) - glm::length(m[j])) <= slack * glm::length(m[i]);
    };
    switch (family_of(kind)) {
    case PrimitiveKind::triangle:
        return true;
    case PrimitiveKind::sphere:
        return upright(0, 1) && upright(0, 2) && upright(1, 2) && equal(0, 1) && equal(0, 2);
    case PrimitiveKind::cube:
        for (int column = 0; column < 3; ++column)
            if (std::count(&m[column].x, &m[column].x + 3, 0.0) != 2) return false;
        return true;
    case PrimitiveKind::cylinder:
    case PrimitiveKind::cone:
    case PrimitiveKind::frustum:
        return upright(0, 1) && upright(0, 2) && upright(1, 2) && equal(0, 2);
    case PrimitiveKind::plane:
    case PrimitiveKind::torus:
        return false;
    }
    return false;
}

double placement_bytes(const Body& body, const Affine& world_from_body) {
    const auto* const kind = std::get_if<PrimitiveKind>(&body.shape);
    if (!kind) return PovrayCosts::placement;
    return PovrayCosts::primitive(*kind) +
           (stays_of_its_kind(*kind, world_from_body.linear) ? 0 : PovrayCosts::matrix);
}

} // namespace

double PovrayCosts::primitive(PrimitiveKind kind) {
    switch (family_of(kind)) {
    case PrimitiveKind::triangle:
        return 400;
    case PrimitiveKind::cylinder:
    case PrimitiveKind::cone:
    case PrimitiveKind::frustum:
        return 640;
    case PrimitiveKind::sphere:
    case PrimitiveKind::cube:
    case PrimitiveKind::plane:
    case PrimitiveKind::torus:
        return 336;
    }
    return 336;
}

double povray_leaf_bytes(PrimitiveKind kind) {
    const bool needs_matrix = kind == PrimitiveKind::sphere || kind == PrimitiveKind::cube;
    return PovrayCosts::primitive(kind) + (needs_matrix ? PovrayCosts::matrix : 0);
}

double povray_bytes(const Cut& cut) {
    double bytes = PovrayCosts::base;
    for (const PlacementGroup& group : cut.groups) {
        bytes += PovrayCosts::own_texture;
        if (cut.palettes[group.palette].size() > 1 && group.tint.alpha > 0) bytes += PovrayCosts::own_layer;
        for_each_placement(group, [&](const Placement& placement) {
            bytes += placement_bytes(cut.bodies[placement.body], placement.world_from_body);
        });
    }
    for (const Palette& palette : cut.palettes)
        if (palette.size() > 1) bytes += PovrayCosts::slot * static_cast<double>(palette.size());
    for (const Body& body : cut.bodies)
        if (const Mesh* mesh = std::get_if<Mesh>(&body.shape))
            bytes += PovrayCosts::triangle * static_cast<double>(mesh->triangles.size()) +
                     PovrayCosts::vertex * static_cast<double>(mesh->vertices.size()) +
                     PovrayCosts::normal * static_cast<double>(mesh->normals.size()) +
                     PovrayCosts::uv * static_cast<double>(mesh->uv.size());
    return bytes;
}

} // namespace graftal
