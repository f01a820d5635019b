#pragma once

// Parts of a cut: bodies, their placements, and the textures that these share.

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "compiler/detail/mesh/mesh.h"
#include "compiler/graph/graph.h"
#include "compiler/povray/packed_placements.h"
#include "compiler/scene/povray_units.h"

namespace graftal {

/// A single exact primitive, or a baked mesh.
struct Body {
    std::string name; ///< of the object it draws, for the reader of the scene; not unique
    std::variant<Primitive, Mesh> shape;
};

inline constexpr std::uint32_t no_operand = UINT32_MAX;

/// An intersection or a difference at its place. Its operands hold groups, and other combined parts.
struct CombinedPart {
    Combination combination = Combination::subtract;
    std::uint32_t holder = no_operand; ///< the operand that it lies in; none: it is drawn by itself
    std::uint32_t first_operand = 0;   ///< the numbers of its operands follow each other
    std::uint32_t operand_count = 0;
};

/// Placements that share a texture: a palette, one tint in front of it, and a finish (the material's rgb is
/// already in the palette). Where the palette has one colour the tint is already in it too. If the material
/// has a picture or a pattern it stands in the palette's place, behind the tint.
struct PlacementGroup {
    std::uint32_t palette = 0;
    PathTint tint;
    Material material;
    double pattern_size = 1;            ///< where the material has a pattern
    std::uint32_t operand = no_operand; ///< that the placements are parts of
    std::vector<Placement> placements;
    std::vector<PackedPlacements> packed; ///< more placements
};

/// Calls `visit` on each Placement of the group.
template<typename Visit> void for_each_placement(const PlacementGroup& group, const Visit& visit) {
    for (const Placement& placement : group.placements)
        visit(placement);
    for (const PackedPlacements& parts : group.packed)
        parts.for_each(visit);
}

struct Cut : DrawnExtent {
    std::vector<Body> bodies;
    std::vector<Palette> palettes;
    std::vector<PlacementGroup> groups;
    std::vector<CombinedPart> combined; ///< before those that they hold
    double error_px = 0; ///< reached: largest projected size of a culled part; 0 if none was culled
    double error_asked_px = 0;
    double tessellation_px = 0; ///< largest distance between a curved surface and its mesh
    std::uint64_t placement_count = 0;
    std::uint64_t triangle_count = 0;
    double leaf_count = 0;             ///< leaves that the picture stands for
    std::uint64_t estimated_bytes = 0; ///< of POV-Ray's memory
};

} // namespace graftal
