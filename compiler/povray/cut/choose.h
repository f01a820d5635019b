#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "compiler/detail/graph/symmetry.h"
#include "compiler/detail/piece.h"
#include "compiler/support/control.h"

namespace graftal {

struct Choice {
    double threshold = 0; ///< pieces that weigh more triangles than this become placements of their parts
    double bytes = 0;     ///< of POV-Ray's memory, estimated
    double text = 0;      ///< bytes of SDL, estimated
    double placements = 0;
    double triangles = 0;
    double leaves = 0;
    double pieces = 0;      ///< pieces looked at: the cost of the choice
    bool spelt_out = false; ///< nothing becomes a mesh, except for shells
};

/// Finds the threshold at which the text is shortest, of those that take at most `most_bytes` of POV-Ray's
/// memory; if none does, the one that takes least. Where memory does not lack, time does: text is what both
/// programs spend it on, and what is shortest takes at most a few times the least memory. Pieces are split
/// heaviest first, as real pieces while there are few, then as counts; the cost of placements only grows, so
/// the search ends where they alone cost more than the best found. The meter, if any, counts pieces.
Choice choose_cut(const DetailGraph& cut, const Symmetry& symmetry, const Projection& projection,
                  const Piece& root, Weights& weights, double most_bytes, WorkMeter* meter = nullptr);

} // namespace graftal
