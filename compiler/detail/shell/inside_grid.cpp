#include "compiler/detail/shell/inside_grid.h"

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

/// Works on a cube of cells, numbered from its lowest corner, x first. The outermost layer is outside for
/// sure.
class Flood {
  public:
    Flood(double cell, std::int64_t reach, const CancelFlag& cancel)
        : control_{cancel, {}}, cell_(cell), reach_(reach), side_(2 * reach),
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
            for (std::int64_t y = 0; y < side_; ++y) {
                meter_.add(static_cast<std::uint64_t>(side_));
                for (std::int64_t x = 0; x < side_; ++x)
                    if (known.has({middle(x), middle(y), middle(z)})) cells_[number(x, y, z)] = taken;
            }
    }

    /// From a corner, which is outside, through the rows of empty cells one after the other (A. R. Smith,
    /// "Tint Fill", 1979). The outermost layer ends rows.
    void run() {
        wet_outermost();
        std::vector<std::size_t> seeds = {number(1, 1, 1)};
        const auto row = static_cast<std::size_t>(side_), layer = row * row;
        while (!seeds.empty()) {
            std::size_t first = seeds.back();
            seeds.pop_back();
            if (cells_[first] != empty) continue;
            std::size_t last = first;
            while (cells_[first - 1] == empty)
                --first;
            while (cells_[last + 1] == empty)
                ++last;
            std::fill(cells_.begin() + static_cast<std::ptrdiff_t>(first),
                      cells_.begin() + static_cast<std::ptrdiff_t>(last + 1), wet);
            meter_.add(last + 1 - first);
            for (const std::size_t beside : {first - row, first + row, first - layer, first + layer})
                for (std::size_t at = beside; at <= beside + (last - first); ++at)
                    if (cells_[at] == empty && (at == beside || cells_[at - 1] != empty)) seeds.push_back(at);
        }
    }

    /// Dry cells with a wet neighbour, also across edges and corners, are the shell; those behind are inside.
    /// Spoils the cells.
    std::shared_ptr<const InsideGrid> inside() {
        for (std::uint8_t& cell : cells_)
            cell = cell == wet;
        const auto row = static_cast<std::size_t>(side_);
        std::vector<std::uint8_t> before;
        for (const std::size_t stride : {std::size_t{1}, row, row * row})
            spread(stride, before);
        if (std::ranges::find(cells_, 0) == cells_.end()) return nullptr;
        std::vector<bool> hidden(cells_.size());
        for (std::size_t i = 0; i < cells_.size(); ++i)
            if (!cells_[i]) hidden[i] = true;
        return std::make_shared<InsideGrid>(cell_, reach_, std::move(hidden));
    }

  private:
    static constexpr std::uint8_t empty = 0, taken = 1, wet = 2;

    std::size_t number(std::int64_t x, std::int64_t y, std::int64_t z) const {
        return static_cast<std::size_t>((z * side_ + y) * side_ + x);
    }

    void wet_outermost() {
        for (const std::int64_t end : {std::int64_t{0}, side_ - 1})
            for (std::int64_t i = 0; i < side_; ++i)
                for (std::int64_t k = 0; k < side_; ++k)
                    cells_[number(end, i, k)] = cells_[number(i, end, k)] = cells_[number(i, k, end)] = wet;
    }

    /// Each cell takes on what is set in it and in those a stride before and after. The outermost are set.
    void spread(std::size_t stride, std::vector<std::uint8_t>& before) {
        before = cells_;
        // In pieces, so that the loop stays one of vectors.
        for (std::size_t first = stride; first + stride < cells_.size(); first += cells_a_look) {
            meter_.add(cells_a_look);
            const std::size_t end = std::min(cells_.size() - stride, first + cells_a_look);
            for (std::size_t i = first; i < end; ++i)
                cells_[i] = static_cast<std::uint8_t>(before[i - stride] | before[i] | before[i + stride]);
        }
    }

    static constexpr std::size_t cells_a_look = 1 << 18;

    const Control control_;
    WorkMeter meter_{control_, "shell", cells_a_look};
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
                                              const InsideGrid* known, std::uint64_t& work,
                                              std::uint64_t most_work, const CancelFlag& cancel) {
    const std::int64_t reach = reach_of(points, cell);
    const auto side = static_cast<double>(2 * reach);
    if (side < least_cells_across || side * side * side > most_cells) return nullptr;
    const std::uint64_t flood_work = static_cast<std::uint64_t>(side * side * side) / cells_a_move;
    if (work > most_work || flood_work > most_work - work) return nullptr;
    work += flood_work;
    Flood flood(cell, reach, cancel);
    flood.take(points);
    if (known) flood.take(*known); // points left out before are no hole
    flood.run();
    return flood.inside();
}

} // namespace graftal
