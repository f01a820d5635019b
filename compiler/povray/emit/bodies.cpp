#include "compiler/povray/emit/bodies.h"

#include <algorithm>

#include "compiler/povray/emit/mesh.h"
#include "compiler/povray/emit/names.h"
#include "compiler/povray/emit/regular_matrix.h"
#include "compiler/povray/primitives.h"
#include "compiler/primitives/sheet.h"
#include "compiler/support/check.h"

namespace graftal {

PovrayBodies::PovrayBodies(const Cut& cut, const std::string& prefix) : cut_(cut), uses_(cut.bodies.size()) {
    std::vector<bool> placed(cut.bodies.size());
    for (const PlacementGroup& group : cut.groups) {
        const std::size_t colours = cut.palettes.at(group.palette).size();
        for (const Placement& placement : group.placements) {
            GRAFTAL_CHECK(placement.body < cut.bodies.size(), "emit_povray: a placement without a body");
            placed[placement.body] = true;
            if (colours > 1) uses_[placement.body].palette = true;
            if (group.operand != no_operand) uses_[placement.body].solid = true;
        }
        for (const PackedPlacements& parts : group.packed)
            for (const std::uint32_t body : parts.body)
                GRAFTAL_CHECK(body < cut.bodies.size(), "emit_povray: a packed placement without a body");
    }
    UniqueNames names(prefix + "M_");
    for (std::size_t i = 0; i < cut.bodies.size(); ++i) {
        if (!placed[i]) continue;
        const Mesh* const mesh = std::get_if<Mesh>(&cut.bodies[i].shape);
        if (!mesh && !povray_primitive(std::get<Primitive>(cut.bodies[i].shape).kind()).declared_bytes)
            continue;
        uses_[i].name = names.next(cut.bodies[i].name);
        if (mesh) triangle_count_ += mesh->triangles.size();
    }
}

bool PovrayBodies::is_plane(std::uint32_t body) const {
    const auto* const primitive = std::get_if<Primitive>(&cut_.bodies[body].shape);
    return primitive && *primitive == PrimitiveKind::plane;
}

bool PovrayBodies::is_sheet(std::uint32_t body, const Mat3& linear) const {
    const auto* const primitive = std::get_if<Primitive>(&cut_.bodies[body].shape);
    return primitive && sheet_of(*primitive, linear);
}

bool PovrayBodies::declare(SdlWriter& out, ProgressMarks& progress) const {
    for (std::size_t i = 0; i < uses_.size(); ++i) {
        if (uses_[i].name.empty()) continue;
        if (const auto* const primitive = std::get_if<Primitive>(&cut_.bodies[i].shape)) {
            out << "\n#declare " << uses_[i].name << " = "
                << povray_primitive(primitive->kind()).text(*primitive)
                << (uses_[i].solid ? inside_vector : std::string_view()) << " }\n";
            continue;
        }
        const Mesh& mesh = std::get<Mesh>(cut_.bodies[i].shape);
        out << "\n// " << harmless(cut_.bodies[i].name) << ": "
            << static_cast<std::uint64_t>(mesh.triangles.size()) << " triangles\n";
        if (!declare_mesh(out, uses_[i].name, mesh, uses_[i].palette, uses_[i].solid, progress)) return false;
    }
    return !out.stopped();
}

void PovrayBodies::place(SdlWriter& out, std::uint32_t body, const Affine& pov_from_body,
                         std::string_view texture) const {
    const auto* const primitive = std::get_if<Primitive>(&cut_.bodies[body].shape);
    if (primitive && uses_[body].name.empty()) {
        const PovrayPrimitive& row = povray_primitive(primitive->kind());
        if (!row.write_placed || !row.write_placed(out, *primitive, pov_from_body)) {
            out << row.text(*primitive) << " ";
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
