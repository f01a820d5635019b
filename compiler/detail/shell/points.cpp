#include "compiler/detail/shell/points.h"

#include <algorithm>
#include <cmath>

#include "compiler/detail/shell/point_system.h"

namespace graftal {

namespace {

using Point = PointSystem::Point;
using CoarseStates = PointSystem::CoarseStates;

/// Grids that tell inside from outside are coarser than the points'.
constexpr double first_cells_across = 96, coarse_step = 2.5;
/// A set this many cells wide is not worth a look inside.
constexpr double least_cells_of_surface = 48;
/// Share of the allowed points that a grid aims at.
constexpr double share_of_points = 0.45;
/// Runs for which all the work suffices, since the cost of a finer grid is not certain. A first look gets
/// less.
constexpr std::uint64_t runs_paid_for = 3, looks_a_run = 8;

/// Predicts how many points a finer grid takes.
class Growth {
  public:
    /// `flat`: in a plane.
    void add(double cell, double points, bool flat) {
        // Points inside of a set in space are left out at some time, so that no growth that was seen can be
        // relied on.
        power_ = flat ? 2 : 2.6;
        last_cell_ = cell;
        last_points_ = std::max(1.0, points);
    }
    /// The least cell that gives at most `points`.
    double finest_for(double points) const {
        return last_cell_ * std::pow(last_points_ / points, 1 / power_);
    }

  private:
    double last_cell_ = 0, last_points_ = 0;
    double power_ = 3;
};

/// True if the points fill no space.
bool in_one_plane(const std::vector<Point>& points, double radius) {
    return std::ranges::all_of(points, [&](const Point& p) {
        return std::abs(static_cast<double>(p[2]) - static_cast<double>(points.front()[2])) <= 1e-5 * radius;
    });
}

/// Finds the finest grid that the limits allow: from coarse ones to finer ones.
class GridSearch {
  public:
    GridSearch(const DetailGraph& cut, NodeId node, std::uint32_t steps, const PointLimits& limits)
        : node_(node), steps_(steps), limits_(limits), most_a_run_(limits.work / runs_paid_for),
          ball_(cut.nodes[node].ball), system_(cut, limits.points, limits.cancel) {}

    PointSet run(double asked) {
        PointSet set;
        set.finest_asked = set.coarsest_asked = asked;
        const double first = 2 * ball_.radius / first_cells_across;
        double cell = asked;
        if (asked < first) cell = refine(first, asked);
        if (limited_) { // all calls for a finer cell get this one
            set.finest_asked = 0;
            set.coarsest_asked = std::nextafter(std::min(cell, first), 0.0);
        }
        if (finish(cell)) take(set);
        set.work = system_.all_work();
        return set;
    }

  private:
    /// Coarse grids first: they say how many points a finer one will have, and what nobody can see. Returns
    /// the cell to try at last.
    double refine(double cell, double asked) {
        while (!look(cell, most_a_run_ / looks_a_run)) {
            cell *= 2;
            limited_ = true;
            if (cell > coarsest()) return cell;
        }
        for (;;) {
            const double finest = finest_cell();
            limited_ = finest >= cell;
            if (limited_) return cell;
            cell = std::max({asked, finest, cell / coarse_step});
            if (cell <= asked) return cell;
            if (look(cell, most_a_run_)) continue;
            limited_ = true;
            failed_ = cell;
            return cell;
        }
    }

    /// Leaves the work of a run for the end.
    bool look(double cell, std::uint64_t most_work) {
        const std::uint64_t looked = system_.all_work() + most_a_run_;
        if (looked >= limits_.work || !run_grid(cell, std::min(most_work, limits_.work - looked)))
            return false;
        affordable_ = cell;
        affordable_work_ = system_.work();
        const bool flat = in_one_plane(system_.root().points, ball_.radius);
        growth_.add(cell, static_cast<double>(system_.kept()), flat);
        moves_a_point_ =
            static_cast<double>(system_.work()) / std::max(1.0, static_cast<double>(system_.kept()));
        if (!flat) coarse_ = system_.take_coarse();
        return true;
    }

    double finest_cell() const {
        const double points =
            std::min(static_cast<double>(limits_.points), static_cast<double>(most_a_run_) / moves_a_point_);
        return growth_.finest_for(share_of_points * points);
    }

    double coarsest() const { return 4 * ball_.radius; }

    /// Makes the grid of a cell, or a coarser one: the prediction may be too fine after all.
    bool finish(double cell) {
        constexpr double coarser = 1.5;
        if (cell != failed_ && try_cell(cell)) return true;
        cell *= coarser;
        if (affordable_ > 0) {
            if (cell < affordable_ && try_cell(cell)) return true;
            if (!run_grid(affordable_, most_a_run_)) return false; // for which work was left
        } else {
            while (!run_grid(cell, most_a_run_ / looks_a_run)) {
                cell *= 2;
                if (cell > coarsest()) return false;
            }
        }
        system_.add_large_parts(); // adds as many as there is room for
        return true;
    }

    bool run_grid(double cell, std::uint64_t most_work) {
        return system_.run(node_, steps_, cell, coarse_, most_work);
    }

    /// Leaves the work to do again what was affordable.
    bool try_cell(double cell) {
        const std::uint64_t needed = system_.all_work() + affordable_work_;
        return needed < limits_.work && run_grid(cell, std::min(most_a_run_, limits_.work - needed)) &&
               system_.add_large_parts();
    }

    void take(PointSet& set) {
        PointSystem::State& state = system_.root();
        set.cell = state.cell;
        set.middle = state.middle;
        set.flat = in_one_plane(state.points, ball_.radius);
        set.points = std::move(state.points);
        set.paints = std::move(state.paints);
        set.inside = state.inside;
    }

    const NodeId node_;
    const std::uint32_t steps_;
    const PointLimits limits_;
    const std::uint64_t most_a_run_;
    const Ball ball_;
    PointSystem system_;
    CoarseStates coarse_;
    Growth growth_;
    double moves_a_point_ = 1;
    double affordable_ = 0, failed_ = 0; ///< the finest cell that was looked at, and one that took too much
    std::uint64_t affordable_work_ = 0;
    bool limited_ = false;
};

} // namespace

PointSet point_set(const DetailGraph& cut, NodeId node, std::uint32_t steps, double detail_per_unit,
                   const PointLimits& limits) {
    const DetailNode& root = cut.nodes[node];
    if (root.unbounded || root.primitive || !(detail_per_unit > 0) || !std::isfinite(detail_per_unit))
        return {};
    return GridSearch(cut, node, steps, limits).run(1 / detail_per_unit);
}

} // namespace graftal
