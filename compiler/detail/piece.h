#pragma once

#include <cstdint>
#include <optional>

#include "compiler/detail/graph/cut_graph.h"
#include "compiler/detail/graph/piece_kind.h"
#include "compiler/detail/projection.h"
#include "compiler/detail/weights.h"

namespace graftal {

/// A subtree at its place in the world.
struct Piece {
    NodeId node = 0;
    std::uint32_t steps = unlimited_steps;
    Affine world_from_node;
    double scale = 1; ///< norm of the linear part
    PathTint tint;
    Rgb inherited{0.8};                 ///< the colour that what names no material shows
    std::optional<MaterialId> material; ///< whose finish it shows
    double turns = 1;                   ///< of a primitive: length_in_turns() of its instance
    bool faint = false;                 ///< stands for a culled set without area
    double light_share = 1; ///< share of the light on it, whose parts would shade themselves (self_shadow.h)
};

/// The look of what an edge leads to, of anything that has a `tint`, the `inherited` colour of what names no
/// material, and the `material`. What stands for a cut node takes on the node's mean colour.
template<typename Looks>
void look_through(const CutGraph& cut, const CutNode& parent, bool parent_is_cut, const CutEdge& edge,
                  const Looks& before, Looks& after) {
    after.tint = before.tint * edge.tint;
    after.inherited =
        parent_is_cut && parent.terminal ? parent.mean.over(before.inherited) : before.inherited;
    after.material = before.material;
    if (!edge.material) return;
    after.material = edge.material;
    after.inherited = cut.materials[*edge.material].rgb;
}

/// Steps down one edge. What stands for a cut node takes on the node's mean colour.
Piece descend(const CutGraph& cut, const Piece& piece, const CutEdge& edge, bool piece_is_cut);

/// The node's ball, placed.
Ball world_ball(const CutGraph& cut, const Piece& piece);
/// The detail of the piece's diameter.
double detail_of(const CutGraph& cut, const Projection& projection, const Piece& piece);

/// The kind of the piece as it lies, not normalised.
PieceKind kind_of(const CutGraph& cut, const Projection& projection, const Piece& piece);

/// The weight of the piece. The parts of what holds a plane are each weighed where they lie, since the whole
/// has no size; infinite where they are too many for that.
Weights::Weight weight_of(const CutGraph& cut, const Projection& projection, Weights& weights,
                          const Piece& piece);

} // namespace graftal
