#pragma once

#include <cstdint>

#include "compiler/detail/graph/detail_graph.h"
#include "compiler/detail/graph/piece_kind.h"
#include "compiler/detail/projection.h"
#include "compiler/detail/weights.h"

namespace graftal {

/// A subtree at its place in the world.
struct Piece : Look {
    NodeId node = 0;
    std::uint32_t steps = unlimited_steps;
    Affine world_from_node;
    double scale = 1;       ///< norm of the linear part
    double turns = 1;       ///< of a primitive: length_in_turns() of its instance
    bool faint = false;     ///< stands for a culled set without area
    double light_share = 1; ///< share of the light on it, whose parts would shade themselves (self_shadow.h)
};

/// Steps down one edge.
Piece descend(const DetailGraph& cut, const Piece& piece, const DetailEdge& edge, bool piece_is_cut);

/// The node's ball, placed.
Ball world_ball(const DetailGraph& cut, const Piece& piece);
/// The detail of the piece's diameter.
double detail_of(const DetailGraph& cut, const Projection& projection, const Piece& piece);

/// The kind of the piece as it lies, not normalised.
PieceKind kind_of(const DetailGraph& cut, const Projection& projection, const Piece& piece);

/// The weight of the piece. The parts of what holds a plane are each weighed where they lie, since the whole
/// has no size; infinite where they are too many for that.
Weights::Weight weight_of(const DetailGraph& cut, const Projection& projection, Weights& weights,
                          const Piece& piece);

} // namespace graftal
