#include "compiler/povray/costs.h"

#include <variant>

#include "compiler/povray/primitives.h"

namespace graftal {

namespace {

double placement_bytes(const Body& body, const Affine& world_from_body) {
    const auto* const primitive = std::get_if<Primitive>(&body.shape);
    if (!primitive) return PovrayCosts::placement;
    const PovrayPrimitive& row = povray_primitive(primitive->kind());
    const bool stays = row.stays_of_its_kind && row.stays_of_its_kind(world_from_body.linear);
    return row.bytes(*primitive) + (stays ? 0 : PovrayCosts::matrix);
}

} // namespace

double povray_leaf_bytes(const Primitive& primitive) {
    const PovrayPrimitive& row = povray_primitive(primitive.kind());
    return row.bytes(primitive) + (row.mostly_needs_matrix ? PovrayCosts::matrix : 0);
}

double povray_bytes(const Mesh& mesh) {
    return PovrayCosts::triangle * static_cast<double>(mesh.triangles.size()) +
           PovrayCosts::vertex * static_cast<double>(mesh.vertices.size()) +
           PovrayCosts::normal * static_cast<double>(mesh.normals.size()) +
           PovrayCosts::uv * static_cast<double>(mesh.uv.size());
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
            bytes += povray_bytes(*mesh);
        else if (const Primitive& primitive = std::get<Primitive>(body.shape);
                 povray_primitive(primitive.kind()).declared_bytes)
            bytes += povray_primitive(primitive.kind()).declared_bytes(primitive);
    return bytes;
}

} // namespace graftal
