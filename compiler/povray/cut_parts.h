#pragma once

// Parts of a cut: bodies, their placements, and the textures that these share.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "compiler/detail/mesh/mesh.h"
#include "compiler/graph/graph.h"
#include "compiler/graph/packed_edges.h"
#include "compiler/graph/run.h"
#include "compiler/scene/povray_units.h"

namespace graftal {

/// A single exact primitive, or a baked mesh.
struct Body {
    std::string name; ///< of the object it draws, for the reader of the scene; not unique
    std::variant<Primitive, Mesh> shape;
};

struct Placement {
    std::uint32_t body = 0;
    Affine world_from_body;
};

/// Placements of the parts of one colour of a range of packed edges, each made where it is looked at: all of
/// them would take three times the memory of the run.
struct PackedPlacements {
    std::shared_ptr<const Run> run;
    std::size_t first = 0, count = 0; ///< items
    std::uint16_t colour = 0;
    Affine world_from_run;
    std::array<std::uint32_t, RunShape::count> body{}; ///< by RunShape::index()
    /// True for bodies and balls of the range's items, in turn, that are drawn elsewhere or not in sight.
    /// Null if none are.
    std::shared_ptr<const std::vector<bool>> left_out;

    std::uint64_t size() const {
        std::uint64_t parts = 0;
        for_each_part([&](RunShape, const RunItem&, bool) { ++parts; });
        return parts;
    }

    /// Calls `visit` on each Placement, bodies before their balls.
    template<typename Visit> void for_each(const Visit& visit) const {
        for_each_part([&](RunShape shape, const RunItem& item, bool ball) {
            const Affine run_from_part = ball ? run_from_round_ball(item) : run_from_round_body(item);
            visit(Placement{body[shape.index()], world_from_run * run_from_part});
        });
    }

  private:
    template<typename Visit> void for_each_part(const Visit& visit) const {
        const auto is_left_out = [&](std::size_t part) { return left_out && (*left_out)[part]; };
        for (std::size_t i = 0; i < count; ++i) {
            const RunItem& item = (*run)[first + i];
            if (item.colour != colour) continue;
            if (!is_left_out(2 * i)) visit(item.shape, item, false);
            if (item.ball && !is_left_out(2 * i + 1)) visit(RunShape(PrimitiveKind::sphere), item, true);
        }
    }
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
