#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "compiler/detail/piece.h"
#include "compiler/detail/shell/cell_table.h"
#include "compiler/detail/shell/inside_grid.h"
#include "compiler/detail/shell/point_set.h"
#include "compiler/support/control.h"
#include "compiler/support/id_table.h"

namespace graftal {

/// The grids of all nodes below one, as point_set() describes them. A grid is run at one size of its cells.
class PointSystem {
  public:
    using Point = std::array<float, 3>;

    /// The part of a run on a coarse grid that the next run uses.
    struct Coarse {
        std::shared_ptr<const InsideGrid> inside;
        std::vector<Point> points; ///< points that are not inside
        std::vector<PointPaint> paints;
    };
    using CoarseStates = std::unordered_map<PieceKind, Coarse, PieceKindHash>;

    /// A node with the levels that it has left, and its points.
    struct State {
        PieceKind key;      ///< of no detail
        double stretch = 0; ///< largest product of stretches on a way from the root
        bool tiny = false;  ///< no larger than a cell: a point is enough
        bool cut = false;
        double cell = 0;
        Vec3 middle{0.0};
        std::vector<Point> points;
        std::vector<PointPaint> paints;
        CellTable cells;
        std::size_t moved = 0; ///< of its points, those that the users have
        struct Use {
            std::uint32_t parent;
            const DetailEdge* edge;
        };
        std::vector<Use> uses;
        std::shared_ptr<const InsideGrid> inside;
    };

    /// Keeps a reference.
    PointSystem(const DetailGraph& cut, std::size_t most_points, const CancelFlag& cancel = {});

    /// Makes the node's grid of these cells, with `most_work` at most. False if a limit is passed.
    bool run(NodeId root, std::uint32_t steps, double cell, const CoarseStates& coarse,
             std::uint64_t most_work);

    /// Samples the primitives of the root's largest parts where they lie: points that went from grid to grid
    /// leave gaps in smooth surfaces. False if a limit is passed.
    bool add_large_parts();

    State& root() { return states_.front(); }
    std::size_t kept() const { return kept_; }
    std::uint64_t work() const { return work_; } ///< of the last run
    std::uint64_t all_work() const { return all_work_ + work_; }

    /// The insides of the larger states, and their points outside of these.
    CoarseStates take_coarse();

  private:
    const DetailNode& node_of(const State& state) const { return cut_.nodes[state.key.node]; }
    double stretch_of(const DetailEdge& edge) const;

    std::optional<std::uint32_t> state_number(PieceKind key);

    /// Largest first, as shortest ways are found (E. Dijkstra 1959); what is met again by a longer way is
    /// done again.
    bool add_states(const PieceKind& root);

    /// The points that a state has of its own, and what it hands on to whom.
    bool start(std::uint32_t number);

    PointPaint paint_of(const Piece& black, const Piece& white) const;

    /// The hull of a set is made of the hulls of its parts: where what is inside is left out, points have to
    /// begin outside.
    bool start_from(std::uint32_t number, const CoarseStates& coarse);

    static PointPaint mean_of(const DetailNode& node);

    /// The stand-in where parts end: the terminal, if there is one, by its own material.
    PointPaint ended(const DetailNode& node) const;

    LookStep step_from(const State& parent, const DetailEdge& edge) const;

    bool sample(std::uint32_t number, const Primitive& primitive, const Affine& node_from_primitive,
                const PointPaint& paint);

    static Point point_of(Vec3 p);

    /// A point of the limit: where the first way round leads, if it is gone for ever.
    bool add_seed(std::uint32_t number);

    static std::uint64_t packed_cell(const Point& point, double cell);

    /// False beyond the limits; a point whose cell is taken, or that nobody can see, is left out.
    bool add(std::uint32_t number, const Point& point, const PointPaint& paint);

    /// Moves every point through every use of its state, until no new ones come.
    bool spread();

    bool move(const State& child, std::size_t first, std::size_t last, const State::Use& use);

    const DetailGraph& cut_;
    std::size_t most_points_;
    std::uint64_t most_work_ = 0; ///< of this run
    bool painted_;
    double cell_ = 0;
    std::vector<State> states_;
    IdTable number_of_; ///< of states, by their keys
    std::size_t kept_ = 0;
    std::uint64_t work_ = 0, all_work_ = 0;
    const Control control_;
    WorkMeter meter_; ///< of points and states; it charges nothing
};

} // namespace graftal
