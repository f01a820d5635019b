#include "runtime/inverse/target.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>

namespace graftal {

namespace {

constexpr std::size_t most_samples = 6144;

template<typename Map> int room_around(const CellSet& set) {
    const int longest = std::max({set.width, set.height, set.depth});
    return longest / (Map::dimensions == 2 ? 2 : 4) + 2;
}

CellSet with_room(const CellSet& set, int room, bool flat) {
    const int behind = flat ? 0 : room;
    CellSet grid(set.width + 2 * room, set.height + 2 * room, set.depth + 2 * behind);
    for (int z = 0; z < set.depth; ++z)
        for (int y = 0; y < set.height; ++y)
            for (int x = 0; x < set.width; ++x)
                if (set.at(x, y, z)) grid.cells[grid.index(x + room, y + room, z + behind)] = true;
    return grid;
}

template<typename Point> CellLattice<Point> grid_of(const CellSet& cells) {
    std::array<std::size_t, CellLattice<Point>::dimensions> sides;
    const std::array<int, 3> all = {cells.width, cells.height, cells.depth};
    for (std::size_t k = 0; k < sides.size(); ++k)
        sides[k] = static_cast<std::size_t>(all[k]);
    return CellLattice<Point>(sides);
}

} // namespace

template<typename Map>
TargetOf<Map>::TargetOf(const CellSet& set)
    : room_(room_around<Map>(set)), cells_(with_room(set, room_, Map::dimensions == 2)),
      grid_(grid_of<Point>(cells_)), near_(grid_.cells(), 0) {
    const std::vector<std::ptrdiff_t> neighbours = grid_.neighbours();
    for (std::size_t cell = 0; cell < grid_.cells(); ++cell) {
        if (!inside(cell)) continue;
        points_.push_back(grid_.middle(grid_.place(cell)));
        bool edge = false;
        for (const std::ptrdiff_t step : neighbours) {
            const std::size_t beside = cell + static_cast<std::size_t>(step);
            near_[beside] = 1;
            edge |= !inside(beside);
        }
        if (edge) edge_.push_back(points_.back());
    }
    const std::vector<std::size_t> nearest = nearest_cells(cells_);
    nearest_.reserve(nearest.size());
    for (const std::size_t cell : nearest)
        nearest_.push_back(grid_.place(cell));
    for (const Point p : points_)
        centre_ += p;
    centre_ /= static_cast<double>(points_.size());
    for (const Point p : points_)
        spread_ += glm::dot(p - centre_, p - centre_);
    spread_ = std::max(1.0, std::sqrt(spread_ / static_cast<double>(points_.size())));
    Draws draws(CounterRandom(1), 0);
    samples_ = drawn(std::min(most_samples / 3, points_.size()), draws);
    const std::vector<Point> more = drawn_edge(2 * samples_.size(), draws);
    samples_.insert(samples_.end(), more.begin(), more.end());
}

template<typename Map>
std::vector<typename Map::Point> TargetOf<Map>::drawn(std::size_t count, Draws& draws) const {
    std::vector<Point> result;
    result.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const std::vector<Point>& from = i % 2 ? edge_ : points_;
        result.push_back(from[draws.below(from.size())]);
    }
    return result;
}

template<typename Map>
std::vector<typename Map::Point> TargetOf<Map>::drawn_edge(std::size_t count, Draws& draws) const {
    std::vector<Point> result;
    for (std::size_t i = 0; i < count; ++i)
        result.push_back(edge_[draws.below(edge_.size())]);
    return result;
}

template class TargetOf<PlaneMap>;
template class TargetOf<SpaceMap>;

} // namespace graftal
