#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "compiler/chaos/alias_table.h"
#include "compiler/chaos/chances.h"
#include "compiler/chaos/surface.h"
#include "compiler/graph/components.h"
#include "compiler/graph/graph.h"
#include "compiler/graph/path.h"

// Random iteration (the chaos game) on an object-instance graph: points of the root, distributed as a random
// walk down from the root would have them that takes each instance by its chance (chances.h).
//
// Points are made upwards, so that one costs a few affine maps of a point however deep it lies. A walk down
// ends in a primitive, or in a *core*: a cyclic component that it cannot leave. In a core a point wanders for
// ever: from (object v, x) to (object u, A x) where u has an instance of v under A, by the chances of the
// walk turned round in time. Whatever state it is in, x is a random point of v (Barnsley, Elton and Hardin
// 1989). From there, or from a random point of a primitive, it climbs to the root, by the chances of the walk
// down turned round too.

namespace graftal {

struct ChaosPoint {
    Vec3 place;
    float rgb[3];
    std::uint32_t map = 0; ///< number of the map applied last among those of cycles; 0: none
};

class ChaosGame {
  public:
    /// Nothing if there is nothing to take points of. Requires that the graph is verified, and contracts by
    /// `rate` an instance in its cycles; the bounds are those of all objects. A graph with cycles that is cut
    /// by levels must be unrolled first (unroll.h).
    static std::optional<ChaosGame> of(const Graph& graph, const Components& components,
                                       const std::vector<ObjectBounds>& bounds, double rate);

    std::uint32_t map_count() const { return map_count_; } ///< of cycles; numbered from 1

  private:
    friend class ChaosPlayer;
    friend struct FlatGame;
    class Builder;
    static constexpr std::uint32_t none = UINT32_MAX;

    /// One step up: an instance, or the end of a climb.
    struct alignas(64) Move {
        Affine map;
        Paint paint;
        std::uint32_t to = none; ///< state; none: the point is in the world
        std::uint32_t material = none;
        std::uint32_t label = 0;
        bool identity = false;
    };

    struct State {
        AliasTables::Range climb;  ///< moves towards the root
        AliasTables::Range wander; ///< moves inside its core
        double leave = 0;          ///< chance that a point of the core climbs from here
        bool at_root = false;      ///< climbing ends here at once
    };

    struct Core {
        AliasTables::Range start;   ///< states, by their share of time
        bool always_leaves = false; ///< every move makes a point
        bool in_world = false;      ///< and so does every state, as it is
        std::optional<Rgb> base;    ///< mean colour of its materials
    };

    /// Where points come from: a primitive under an instance, packed edges, or a core.
    struct Source {
        std::uint32_t core = none;
        std::uint32_t state = none; ///< of the object that has the instance
        std::optional<PlacedSurface> surface;
        PackedEdges packed; ///< then one of their items, and `state` is of the object that has them
        AliasTables::Range items;
        Paint paint;
        std::uint32_t material = none;
    };

    AliasTables tables_;
    std::vector<Move> moves_;
    std::vector<State> states_;
    std::vector<std::uint32_t> entries_; ///< states of cores
    std::vector<Vec3> middles_;          ///< of the objects of states
    std::vector<Core> cores_;
    std::vector<Source> sources_;
    AliasTables::Range source_choice_;
    std::vector<Rgb> materials_;
    std::uint32_t map_count_ = 0;
    std::uint32_t settling_ = 64; ///< moves until where a core's point began is forgotten
};

/// A sequence of random points: a function of the game, the seed and the number of the sequence.
class ChaosPlayer {
  public:
    ChaosPlayer(const ChaosGame& game, std::uint64_t seed, std::uint64_t sequence);
    /// The next points. Sequences do not depend on how they are divided, where each part is a multiple of
    /// `grain`.
    void fill(std::span<ChaosPoint> points);
    static constexpr std::size_t grain = 4;

  private:
    /// Points that wander at a time in each core: a move waits for the one before.
    static constexpr std::size_t together = grain;

    struct Wanderer {
        Vec3 place{0.0};
        Paint paint;
        std::uint32_t state = 0;
        std::uint32_t map = 0;
    };

    ChaosPoint next();
    void fill_in_world(std::span<ChaosPoint> points);
    void wander(Wanderer& wanderer);
    Wanderer* settled(std::uint32_t core);
    ChaosPoint climb(Wanderer at, std::uint32_t material, const std::optional<Rgb>& base);
    ChaosPoint seen(const Wanderer& at, const Rgb& behind) const;

    const ChaosGame& game_;
    RandomStream random_;
    std::vector<Wanderer> wanderers_; ///< by core, `together` each
    std::vector<std::uint8_t> next_;  ///< by core: the one to move next; `unsettled` at first
};

} // namespace graftal
