#pragma once

// The cut: Graph + View + budget -> bodies and placements. POV-Ray shares only mesh data between instances,
// so a scene is one level of instancing: a list of placements of shared baked meshes (and of single
// primitives). Which subtrees become meshes is chosen so that the whole costs least memory; with N visible
// leaves both lists are about sqrt(N) long.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "compiler/analysis/bounding.h"
#include "compiler/analysis/contraction.h"
#include "compiler/detail/detail_options.h"
#include "compiler/detail/mesh.h"
#include "compiler/detail/run_placements.h"
#include "compiler/graph/components.h"
#include "compiler/povray/povray_units.h"
#include "compiler/scene/scene.h"
#include "compiler/support/diagnostics.h"

namespace graftal {

struct CutOptions {
    bool flatten = false; ///< every leaf its own placement: the absolute specification
    bool operator==(const CutOptions&) const = default;
};

/// A single exact primitive, or a baked mesh.
struct Body {
    std::string name; ///< of the object it draws, for the reader of the scene; not unique
    std::variant<PrimitiveKind, Mesh> shape;
};

struct Placement {
    std::uint32_t body = 0;
    Affine world_from_body;
};

/// Placements that share a texture: a palette, one tint in front of it, and a finish (the material's rgb is
/// already in the palette). Where the palette has one colour the tint is already in it too. If the material
/// has a picture it stands in the palette's place, behind the tint.
struct PlacementGroup {
    std::uint32_t palette = 0;
    PathTint tint;
    Material material;
    std::vector<Placement> placements;
    std::vector<RunPlacements> runs; ///< more placements, see for_each_placement()
};

/// Calls `visit` on a Placement for each part.
template<typename Visit> void for_each_placement(const RunPlacements& parts, const Visit& visit) {
    for_each_part(parts, [&](PrimitiveKind kind, const RunItem& item, bool ball) {
        const Affine run_from_part = ball ? run_from_round_ball(item) : run_from_round_body(item);
        visit(Placement{parts.body[static_cast<std::size_t>(kind)], parts.world_from_run * run_from_part});
    });
}

/// Calls `visit` on each Placement of the group, those of runs too, which are made for it one by one.
template<typename Visit> void for_each_placement(const PlacementGroup& group, const Visit& visit) {
    for (const Placement& placement : group.placements)
        visit(placement);
    for (const RunPlacements& parts : group.runs)
        for_each_placement(parts, visit);
}

struct Cut : DrawnExtent {
    std::vector<Body> bodies;
    std::vector<Palette> palettes;
    std::vector<PlacementGroup> groups;
    double error_px = 0; ///< reached: largest projected size of a culled part; 0 if none was culled
    double error_asked_px = 0;
    double tessellation_px = 0; ///< largest distance between a curved surface and its mesh
    std::uint64_t placement_count = 0;
    std::uint64_t triangle_count = 0;
    double leaf_count = 0;             ///< leaves that the picture stands for
    std::uint64_t estimated_bytes = 0; ///< of POV-Ray's memory
};

struct PreparedCut;

/// Cuts the graph for the view. Nothing, after an error in `diagnostics`, where the budget cannot be kept
/// (with culling off) or the depth has no end; a budget that only allows a coarser picture gives that, with
/// a warning that states the error reached. Requires a verified graph whose contraction is proved or acyclic.
std::optional<Cut> cut_graph(const Graph& graph, const Components& components,
                             const std::vector<ObjectBounds>& bounds, const View& view,
                             const DetailOptions& detail, Diagnostics& diagnostics,
                             const CutOptions& options = {});

/// The same, of a graph that is prepared already. Requires that it was by detail.preparing(), and that
/// refuse_endless() lets it pass.
std::optional<Cut> cut_prepared(const Graph& graph, const PreparedCut& prepared, const View& view,
                                const DetailOptions& detail, Diagnostics& diagnostics,
                                const CutOptions& options = {});

} // namespace graftal
