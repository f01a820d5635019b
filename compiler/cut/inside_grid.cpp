#include "compiler/cut/inside_grid.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace graftal {

namespace {

using Point = std::array<float, 3>;

constexpr double most_cells = 3e7;
constexpr double least_cells_across = 12;
/// Cells that are flooded in the time of moving a point.
constexpr std::uint64_t cells_a_move = 8;

std::int64_t place_of(float coordinate, double cell) {
    return static_cast<std::int64_t>(std::floor(static_cast<double>(coordinate) / cell));
}

/// Cells from the origin to the farthest point, and a few more that are outside for sure.
std::int64_t reach_of(const std::vector<Point>& points, double cell) {
    float far = 0;
    for (const Point& point : points)
        for (const float coordinate : point)
            far = std::max(far, std::abs(coordinate));
    return static_cast<std::int64_t>(static_cast<double>(far) / cell) + 3;
}

/// Works on a cube of cells, numbered from its lowest corner, x first.
class Flood {
  public:
    Flood(double cell, std::int64_t reach)
        : cell_(cell), reach_(reach), side_(2 * reach),
          cells_(static_cast<std::size_t>(side_ * side_ * side_)) {}

    void take(const std::vector<Point>& points) {
        for (const Point& p : points)
            cells_[number(place_of(p[0], cell_) + reach_, place_of(p[1], cell_) + reach_,
                          place_of(p[2], cell_) + reach_)] = taken;
    }

    void take(const InsideGrid& known) {
        const auto middle = [&](std::int64_t at) {
            return static_cast<float>(cell_ * (static_cast<double>(at - reach_) + 0.5));
        };
        for (std::int64_t z = 0; z < side_; ++z)
            for (std::int64_t y = 0; y < side_; ++y)
                for (std::int64_t x = 0; x < side_; ++x)
                    if (known.has({middle(x), middle(y), middle(z)})) cells_[number(x, y, z)] = taken;
    }

    /// From a corner, which is outside.
    void run() {
        const std::int64_t strides[3] = {1, side_, side_ * side_};
        std::vector<std::int64_t> front = {0}, next;
        cells_[0] = wet;
        while (!front.empty()) {
            next.clear();
            for (const std::int64_t cell : front)
                for (const std::int64_t stride : strides) {
                    const std::int64_t place = cell / stride % side_;
                    for (const int step : {-1, 1}) {
                        if (place + step < 0 || place + step >= side_) continue;
                        std::uint8_t& there = cells_[static_cast<std::size_t>(cell + step * stride)];
                        if (there != empty) continue;
                        there = wet;
                        next.push_back(cell + step * stride);
                    }
                }
            front.swap(next);
        }
    }

    /// Dry cells with a wet neighbour, also across edges and corners, are the shell; those behind are inside.
    std::shared_ptr<const InsideGrid> inside() const {
        std::vector<bool> hidden(cells_.size());
        bool any = false;
        for (std::int64_t z = 1; z + 1 < side_; ++z)
            for (std::int64_t y = 1; y + 1 < side_; ++y)
                for (std::int64_t x = 1; x + 1 < side_; ++x) {
                    if (!is_behind(x, y, z)) continue;
                    hidden[number(x, y, z)] = true;
                    any = true;
                }
        return any ? std::make_shared<InsideGrid>(cell_, reach_, std::move(hidden)) : nullptr;
    }

  private:
    enum : std::uint8_t { empty, taken, wet };

    std::size_t number(std::int64_t x, std::int64_t y, std::int64_t z) const {
        return static_cast<std::size_t>((z * side_ + y) * side_ + x);
    }

    bool is_behind(std::int64_t x, std::int64_t y, std::int64_t z) const {
        if (cells_[number(x, y, z)] == wet) return false;
        for (std::int64_t dz = -1; dz <= 1; ++dz)
            for (std::int64_t dy = -1; dy <= 1; ++dy)
                for (std::int64_t dx = -1; dx <= 1; ++dx)
                    if (cells_[number(x + dx, y + dy, z + dz)] == wet) return false;
        return true;
    }

    double cell_;
    std::int64_t reach_, side_;
    std::vector<std::uint8_t> cells_;
};

} // namespace

bool InsideGrid::has(const Point& point) const {
    std::int64_t at[3];
    for (std::size_t k = 0; k < 3; ++k) {
        at[k] = place_of(point[k], cell_) + reach_;
        if (at[k] < 0 || at[k] >= 2 * reach_) return false;
    }
    return hidden_[static_cast<std::size_t>((at[2] * 2 * reach_ + at[1]) * 2 * reach_ + at[0])];
}

std::shared_ptr<const InsideGrid> find_inside(const std::vector<Point>& points, double cell,
                                              const InsideGrid* known, std::uint64_t& work) {
    const std::int64_t reach = reach_of(points, cell);
    const auto side = static_cast<double>(2 * reach);
    if (side < least_cells_across || side * side * side > most_cells) return nullptr;
    work += static_cast<std::uint64_t>(side * side * side) / cells_a_move;
    Flood flood(cell, reach);
    flood.take(points);
    if (known) flood.take(*known); // what was left out is no hole
    flood.run();
    return flood.inside();
}

} // namespace graftal
