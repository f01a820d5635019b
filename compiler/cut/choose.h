#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "compiler/cut/detail.h"
#include "compiler/cut/symmetry.h"

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
    bool faint = false;                 ///< it stands for a set without area that was culled
};

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

struct Choice {
    double threshold = 0; ///< pieces that weigh more triangles than this become placements of their parts
    double bytes = 0;     ///< of POV-Ray's memory, estimated
    double text = 0;      ///< bytes of SDL, estimated
    double placements = 0;
    double triangles = 0;
    double leaves = 0;
    double pieces = 0;      ///< that were looked at: what choosing has cost
    bool spelt_out = false; ///< nothing becomes a mesh, except for shells
};

/// How many of a cube's 12 triangles stay visible, on average, where cubes are baked together: measured on a
/// piece of some thousand cubes. 12 if the graph bakes no cubes, or none that is soon baked. `visits`: of
/// nodes and leaves, what this has cost.
double visible_cube_triangles(const CutGraph& cut, const Symmetry& symmetry, std::uint32_t steps,
                              std::uint64_t* visits = nullptr);

/// Finds the threshold at which the text is shortest, of those that take at most `most_bytes` of POV-Ray's
/// memory; if none does, the one that takes least. Where memory does not lack, time does: text is what both
/// programs spend it on, and what is shortest takes at most a few times the least memory. Pieces are split
/// heaviest first, as real pieces while there are few, then as counts; the cost of placements only grows, so
/// the search ends where they alone cost more than the best found.
Choice choose_cut(const CutGraph& cut, const Symmetry& symmetry, const Projection& projection,
                  const Piece& root, Weights& weights, double most_bytes);

} // namespace graftal
