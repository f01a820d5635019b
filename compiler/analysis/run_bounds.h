#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "compiler/graph/run.h"
#include "compiler/support/bounds.h"

namespace graftal {

/// The box that an item fills, its ball included. Exact except for rounding, which it allows for.
Box box_of(const RunItem& item);

/// Boxes about ranges of a run. Items that follow each other lie near each other (order_in_space()): the
/// boxes of ranges, of ranges of these and so on make a tree.
class RunBounds {
  public:
    static constexpr std::size_t items_a_range = 32; ///< of the lowest level
    static constexpr std::size_t ranges_a_range = 8; ///< of the others

    /// Requires a sound run that is not empty. O(items).
    explicit RunBounds(std::shared_ptr<const Run> run);

    const Run& run() const { return *run_; }
    const Box& box() const { return levels_.back().front(); }
    /// A ball about all, its radius within a millionth of the least, or nearly so.
    Ball ball() const { return ball_; }

    std::size_t level_count() const { return levels_.size(); }
    /// The ranges of a level, the lowest first; the last level has one.
    const std::vector<Box>& boxes(std::size_t level) const { return levels_[level]; }
    /// Number of items in a range of the level, except its last.
    static std::size_t range_size(std::size_t level);

    /// A point of the run that is farthest along `direction`; about O(log items).
    Vec3 support_point(Vec3 direction) const;
    /// A point of the item that lies nearest to `point`: on its side, farthest towards the eye. O(items).
    Vec3 surface_near(Vec3 point, Vec3 to_eye) const;

  private:
    template<typename UpperOf, typename OfItem>
    void search(const UpperOf& upper_of, const OfItem& of_item) const;
    double farthest_from(Vec3 centre, Vec3& point) const;
    void find_ball();

    std::shared_ptr<const Run> run_;
    std::vector<std::vector<Box>> levels_;
    Ball ball_;
};

} // namespace graftal
