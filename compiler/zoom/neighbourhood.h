#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "compiler/analysis/bounding.h"
#include "compiler/graph/components.h"
#include "compiler/graph/graph.h"
#include "compiler/support/control.h"
#include "compiler/zoom/near_ways.h"

namespace graftal {

/// A subtree as it lies in the frame of the object that a descent has reached.
struct NearPiece {
    ObjectId object = 0;
    Affine frame_from_piece;
    double error = 0; ///< how far rounding may have moved it, in units of the frame
    PathTint tint;    ///< of its path from the root
    std::optional<MaterialId> material;
    unsigned levels = 0;                ///< levels that its path has used up (graph.h, "Levels")
    std::uint32_t way = NearWays::root; ///< its path
};

/// The parts around an object deep in the unfolding. The descent goes from the root down, instance by
/// instance. The frame is always that of the object reached, so no number is in coordinates of the world.
/// Parts within reach are carried along, in pieces no larger than the object itself or the reach.
///
/// The maps between an object and its neighbours are f_a^-1 f_b for two addresses a and b of equal size: each
/// step down enlarges the rounding of the last. Where two parts touch, as the triangles of a gasket do, only
/// few such maps occur (the neighbour maps of Bandt and Graf 1992). So a map that equals an earlier one
/// within the rounding of both is taken to be that one, and the rounding starts anew. Where none recurs, a
/// neighbour is lost once rounding hides where it lies.
class Neighbourhood {
  public:
    /// `steps`: levels in all; nothing if there is no limit. `meter` counts steps down and pieces looked at.
    Neighbourhood(const Graph& graph, const Components& components, const std::vector<ObjectBounds>& bounds,
                  std::optional<unsigned> steps, WorkMeter& meter);

    enum class Outcome { done, flat, too_many, no_level };

    /// Goes down one instance of the object reached. What has no point within `reach` of `focus` (both in the
    /// new frame) is left behind. `flat`: the map cannot be inverted; `too_many`: more pieces than
    /// `most_pieces`, or more than `most_looks` to find them; `no_level`: the steps do not lead so deep. The
    /// pieces are as before then.
    Outcome descend(std::uint32_t instance, Vec3 focus, double reach);

    /// Stays where it is, and leaves no piece in reach that is larger than `size` if it has parts; the object
    /// itself counts as a piece from now on. False: too many.
    bool spread(Vec3 focus, double reach, double size);

    const NearPiece& own() const { return own_; }
    const std::vector<NearPiece>& others() const { return others_; }
    /// The paths of all pieces; to be taken when the descent has ended.
    NearWays& ways() { return ways_; }
    std::size_t lost() const { return lost_; }
    /// True if there were too many for most_looks at last, and not for most_pieces.
    bool looked_too_often() const { return looks_ > most_looks; }
    /// Radius of the ball of a piece, in the frame.
    double radius(const NearPiece& piece) const;

    static constexpr std::size_t most_pieces = 20'000;
    /// Pieces that one descend() or spread() looks at: of crushed ones, countless may come within reach and
    /// none lie there.
    static constexpr std::uint64_t most_looks = 2'000'000;

  private:
    struct KnownMap {
        Affine frame_from_piece;
        double error;
    };

    std::optional<NearPiece> child(const NearPiece& piece, std::uint32_t instance);
    bool in_reach(const NearPiece& piece, Vec3 focus, double reach) const;
    bool divisible(const NearPiece& piece) const;
    /// Appends the parts of the piece that are in reach and no larger than `size`.
    bool keep(NearPiece piece, Vec3 focus, double reach, double size, std::vector<NearPiece>& kept);
    /// Keeps the memory of ways to about that of the pieces that are left.
    void forget_ways();
    void snap(NearPiece& piece);
    void tidy(std::vector<NearPiece>& pieces, double size) const;

    const Graph& graph_;
    const Components& components_;
    const std::vector<ObjectBounds>& bounds_;
    std::optional<unsigned> steps_;
    WorkMeter& meter_;
    NearPiece own_;
    std::vector<NearPiece> others_;
    std::map<std::pair<ObjectId, ObjectId>, std::vector<KnownMap>>
        known_of_pair_; ///< object reached and piece
    std::vector<KnownMap> known_;
    NearWays ways_;
    std::size_t most_way_steps_ = 1 << 16; ///< before some are forgotten
    std::size_t lost_ = 0;
    std::uint64_t looks_ = 0; ///< of the last descend() or spread()
};

} // namespace graftal
