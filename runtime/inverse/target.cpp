#include "runtime/inverse/target.h"

#include <algorithm>
#include <cmath>

namespace graftal {

namespace {

constexpr std::size_t most_samples = 6144;

int room_around(const CellSet& set) {
    return std::max(set.width, set.height) / 2 + 2;
}

CellSet with_room(const CellSet& set) {
    const int room = room_around(set);
    CellSet grid(set.width + 2 * room, set.height + 2 * room);
    for (int y = 0; y < set.height; ++y)
        for (int x = 0; x < set.width; ++x)
            if (set.at(x, y)) grid.cells[grid.index(x + room, y + room)] = true;
    return grid;
}

} // namespace

Target::Target(const CellSet& set)
    : grid_(with_room(set)), room_(room_around(set)), last_x_(grid_.width - 1), last_y_(grid_.height - 1),
      near_(grid_.cells.size(), 0) {
    for (int y = 0; y < grid_.height; ++y)
        for (int x = 0; x < grid_.width; ++x) {
            if (!grid_.at(x, y)) continue;
            points_.emplace_back(x + 0.5, y + 0.5);
            bool edge = false;
            for (int v = y - 1; v <= y + 1; ++v)
                for (int u = x - 1; u <= x + 1; ++u) {
                    near_[grid_.index(u, v)] = 1;
                    edge |= !grid_.at(u, v);
                }
            if (edge) edge_.push_back(points_.back());
        }
    const std::vector<std::size_t> nearest = nearest_cells(grid_);
    nearest_.reserve(nearest.size());
    const auto width = static_cast<std::size_t>(grid_.width);
    for (const std::size_t cell : nearest)
        nearest_.emplace_back(static_cast<double>(cell % width) + 0.5,
                              static_cast<double>(cell / width) + 0.5);
    for (const Vec2 p : points_)
        centre_ += p;
    centre_ /= static_cast<double>(points_.size());
    for (const Vec2 p : points_) {
        const Vec2 away = p - centre_;
        spread_ += away.x * away.x + away.y * away.y;
    }
    spread_ = std::max(1.0, std::sqrt(spread_ / static_cast<double>(points_.size())));
    Draws draws(CounterRandom(1), 0);
    samples_ = drawn(std::min(most_samples / 3, points_.size()), draws);
    const std::vector<Vec2> more = drawn_edge(2 * samples_.size(), draws);
    samples_.insert(samples_.end(), more.begin(), more.end());
}

std::vector<Vec2> Target::drawn(std::size_t count, Draws& draws) const {
    std::vector<Vec2> result;
    result.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const std::vector<Vec2>& from = i % 2 ? edge_ : points_;
        result.push_back(from[draws.below(from.size())]);
    }
    return result;
}

std::vector<Vec2> Target::drawn_edge(std::size_t count, Draws& draws) const {
    std::vector<Vec2> result;
    for (std::size_t i = 0; i < count; ++i)
        result.push_back(edge_[draws.below(edge_.size())]);
    return result;
}

} // namespace graftal
