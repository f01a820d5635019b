#pragma once

#include <cstdint>
#include <vector>

#include "compiler/analysis/outer.h"
#include "compiler/graph/graph.h"

namespace graftal {

/// The support function of a limit set in one direction: h = max of <direction, x>.
struct Support {
    double upper = 0; ///< h <= upper
    double lower =
        0; ///< reached by `point` (to rounding); minus infinity: it is out of range, and no point is known
    Vec3 point{0.0};
};

/// Best-first search for support functions (Duda 2007): unfolds the pieces that may reach farthest, as
/// h_v(d) = max over instances of h_u(A^T d) + <t, d>. Keeps its storage between queries.
class SupportSearch {
  public:
    /// Both are referred to. Outers must hold true bounds of the masters that a query meets.
    SupportSearch(const Graph& graph, const Outers& outers) : graph_(graph), outers_(outers) {}

    /// Stops when upper - lower <= tolerance or after about `most_pieces` pieces; `upper` is true anyway,
    /// except for 1e-12 of the object's size. Requires an object that is neither a primitive nor
    /// empty.
    Support run(ObjectId object, Vec3 direction, double tolerance, std::uint64_t most_pieces);

    /// Pieces looked at in the last run.
    std::uint64_t pieces() const { return pieces_; }

  private:
    struct Piece {
        Vec3 direction; // in the frame of the object
        double offset = 0;
        double upper = 0;
        double at_centre = 0; // offset + <direction, centre>, to compare pieces of equal direction
        ObjectId object = 0;
        std::uint32_t parent = 0; // piece number
        std::uint32_t instance = 0;
        bool dominated = false;
    };
    /// An object and a direction, rounded so that products of the same factors in other orders are equal.
    struct Key {
        std::int64_t x = 0, y = 0, z = 0;
        std::int32_t exponent = 0;
        ObjectId object = 0;
        bool operator==(const Key&) const = default;
    };
    /// Small, as most of what a search waits for is memory: the key is made again from the piece.
    struct Slot {
        std::uint32_t hash = 0;
        std::uint32_t piece = 0;
        std::uint32_t run = 0; // the run that filled it
    };

    void expand(std::uint32_t parent);
    void push(const Piece& piece);
    /// False if the piece is not the farthest of its object and direction: only that one matters.
    bool merge(const Piece& piece, std::uint32_t number);
    bool nearer(std::uint32_t a, std::uint32_t b) const {
        return arena_[a].upper != arena_[b].upper ? arena_[a].upper < arena_[b].upper : a > b;
    }
    Slot& slot_for(const Key& key, std::uint32_t hash);
    void grow_table();
    static std::uint32_t hash_of(const Key& key);
    Vec3 point_in_root(std::uint32_t parent, std::uint32_t instance, Vec3 point) const;
    static Key key_of(const Piece& piece);

    const Graph& graph_;
    const Outers& outers_;
    std::vector<Piece> arena_;
    std::vector<std::uint32_t> heap_;
    std::vector<Slot> table_;
    std::size_t mask_ = 0; // of the part of the table that this run uses: small runs stay in the cache
    std::size_t filled_ = 0;
    std::uint32_t run_ = 0;
    std::uint64_t pieces_ = 0;
    double tolerance_ = 0;
    double discarded_ = 0; // largest upper of the pieces that cannot matter
    double magnitude_ = 0; // of the terms added up, for their rounding
    double best_ = 0;
    std::uint32_t best_parent_ = 0;
    std::uint32_t best_instance_ = 0;
    Vec3 best_point_{0.0};
};

} // namespace graftal
