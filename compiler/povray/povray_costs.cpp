#include "compiler/povray/povray_costs.h"

#include <variant>

#include "compiler/povray/literal_form.h"

namespace graftal {

namespace {

double placement_bytes(const Body& body, const Affine& world_from_body) {
    const auto* const kind = std::get_if<PrimitiveKind>(&body.shape);
    if (!kind) return PovrayCosts::placement;
    return PovrayCosts::primitive(*kind) +
           (needs_no_matrix(*kind, world_from_body.linear) ? 0 : PovrayCosts::matrix);
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
