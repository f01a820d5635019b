#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "compiler/detail/graph/edge_cell.h"
#include "compiler/detail/piece.h"

namespace graftal {

/// Ranges of runs that are spelt out in a cut, by the pieces that hold them: what is known of all of them
/// before they are sorted by their looks.
class PlacedRuns {
  public:
    struct Range {
        std::shared_ptr<const CellSource> source;
        std::size_t first = 0, count = 0;                  ///< items
        Piece piece;                                       ///< the cell of the items
        std::shared_ptr<const std::vector<bool>> left_out; ///< PackedPlacements::left_out
    };

    /// Whether the parts of a cell can be placed as they are: none has a picture, or is to be drawn wider.
    static bool can_hold(const DetailGraph& cut, const Piece& piece);

    /// Requires can_hold().
    void add(const Piece& piece, const EdgeCell& cell);

    /// Primitives.
    std::size_t part_count() const { return parts_; }
    const std::vector<Range>& ranges() const { return ranges_; }

    /// Leaves out what is out of sight, if that is asked for, and what coincides with another part: POV-Ray
    /// draws tens of thousands of coincident objects black. Returns the least length that may be seen
    /// (Cut::finest). Takes eight bytes a part until it is done.
    double sift(const DetailGraph& cut, const Projection& projection);

  private:
    std::vector<Range> ranges_;
    std::size_t parts_ = 0;
};

} // namespace graftal
