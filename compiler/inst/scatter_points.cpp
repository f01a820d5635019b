#include "compiler/inst/scatter_points.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "compiler/support/stage_price.h"

namespace graftal {

namespace {

/// Darts that miss in a row once about a hundredth of the area is still open.
constexpr double most_misses = 400;
/// Candidates around each place: Bridson's 30 leave gaps.
constexpr int candidates = 60;
/// Tries to find an even pattern of which as many places as asked for lie in the area.
constexpr int most_attempts = 120;
constexpr int samples_a_side = 256;

/// Areas that a point is held against in the time of a random number.
constexpr double areas_a_draw = 8;

/// Counts a point that is held against an area, and against each of those that are left out.
void count_point(const ScatterArea& area, WorkMeter* meter) {
    if (meter) meter->add(1, StagePrice::draw / areas_a_draw * static_cast<double>(1 + area.without.size()));
}

/// Draws one after the other, which a meter counts, as it does the places that they make.
class Draws {
  public:
    Draws(CounterRandom random, WorkMeter* meter) : stream_(random), meter_(meter) {}

    double unit() {
        if (meter_) meter_->add(1, StagePrice::draw);
        return stream_.unit();
    }
    bool lies_in(const ScatterArea& area, Vec2 p) {
        if (!area.without.empty()) count_point(area, meter_);
        return area.contains(p);
    }
    double size_of(const ScatterArea& area) { return area.size(meter_); }
    Vec2 in_square() {
        const double x = unit();
        return {x, unit()};
    }
    Vec2 in(const FlatArea& area) { return area.low + in_square() * (area.high - area.low); }

  private:
    RandomStream stream_;
    WorkMeter* meter_;
};

/// Places by cell, so that those near a place are found at once.
class NearGrid {
  public:
    /// A grid for about `count` places, which may be many more than fit.
    NearGrid(const FlatArea& area, double apart, std::size_t count) : low_(area.low), apart_(apart) {
        const Vec2 extent = area.high - area.low;
        const double most_cells = 4 * static_cast<double>(count) + 4;
        cell_ = std::max({apart, std::sqrt(extent.x * extent.y / most_cells), extent.x / most_cells,
                          extent.y / most_cells});
        columns_ = static_cast<int>(extent.x / cell_) + 1;
        rows_ = static_cast<int>(extent.y / cell_) + 1;
        first_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), none);
    }

    bool free(Vec2 p) const {
        const glm::ivec2 c = cell_of(p);
        for (int y = std::max(c.y - 1, 0); y <= std::min(c.y + 1, rows_ - 1); ++y)
            for (int x = std::max(c.x - 1, 0); x <= std::min(c.x + 1, columns_ - 1); ++x)
                if (occupied(x, y, p)) return false;
        return true;
    }

    void add(Vec2 p) {
        const glm::ivec2 c = cell_of(p);
        std::uint32_t& first = first_[index(c.x, c.y)];
        next_.push_back(first);
        first = static_cast<std::uint32_t>(points_.size());
        points_.push_back(p);
    }

    const std::vector<Vec2>& points() const { return points_; }

  private:
    static constexpr std::uint32_t none = UINT32_MAX;

    glm::ivec2 cell_of(Vec2 p) const {
        return glm::clamp(glm::ivec2((p - low_) / cell_), glm::ivec2(0), glm::ivec2(columns_ - 1, rows_ - 1));
    }
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(x);
    }

    bool occupied(int x, int y, Vec2 p) const {
        for (std::uint32_t i = first_[index(x, y)]; i != none; i = next_[i]) {
            const Vec2 d = points_[i] - p;
            if (d.x * d.x + d.y * d.y < apart_ * apart_) return true;
        }
        return false;
    }

    Vec2 low_;
    double apart_, cell_;
    int columns_, rows_;
    std::vector<std::uint32_t> first_; ///< place of a cell
    std::vector<std::uint32_t> next_;  ///< the one added to its cell before, by place
    std::vector<Vec2> points_;
};

void throw_darts(const ScatterArea& area, std::size_t count, Draws& draws, NearGrid& grid) {
    const double enough = most_misses * area.within.size() / draws.size_of(area);
    for (double misses = 0; misses < enough && grid.points().size() < count;) {
        const Vec2 p = draws.in(area.within);
        const bool hit = draws.lies_in(area, p) && grid.free(p);
        misses = hit ? 0 : misses + 1;
        if (hit) grid.add(p);
    }
}

/// Candidates lie in the ring from `apart` to twice that around a place.
void fill_gaps(const ScatterArea& area, std::size_t count, double apart, Draws& draws, NearGrid& grid) {
    for (std::size_t i = 0; i < grid.points().size(); ++i)
        for (int k = 0; k < candidates && grid.points().size() < count; ++k) {
            const Vec2 offset = 4.0 * draws.in_square() - 2.0;
            const double square = offset.x * offset.x + offset.y * offset.y;
            if (square < 1 || square > 4) continue;
            const Vec2 p = grid.points()[i] + apart * offset;
            if (draws.lies_in(area, p) && grid.free(p)) grid.add(p);
        }
}

/// Takes `count` of the points, in their order, all with the same chance.
std::vector<Vec2> thinned(const std::vector<Vec2>& points, std::size_t count, Draws draws) {
    std::vector<Vec2> kept;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (draws.unit() * static_cast<double>(points.size() - i) < static_cast<double>(count - kept.size()))
            kept.push_back(points[i]);
    return kept;
}

/// A lattice of about `cells` cells over the bounds, and what of its jittered places lies in the area.
std::vector<Vec2> jittered_lattice(const ScatterArea& area, double cells, Draws draws) {
    const Vec2 extent = area.within.high - area.within.low;
    const double columns =
        std::clamp(std::round(std::sqrt(cells * (extent.x / extent.y))), 1.0, std::ceil(cells));
    const double rows = std::ceil(cells / columns);
    const Vec2 cell = extent / Vec2(columns, rows);
    std::vector<Vec2> points;
    for (double y = 0; y < rows; ++y)
        for (double x = 0; x < columns; ++x) {
            const Vec2 p = area.within.low + (Vec2(x, y) + draws.in_square()) * cell;
            if (draws.lies_in(area, p)) points.push_back(p);
        }
    return points;
}

/// The turn between neighbours: a circle divided by the golden section, twice.
constexpr Vec2 golden_turn(-0.73736887807831985597, 0.67549029426152362739);

Vec2 turned(Vec2 a, Vec2 by) {
    return {a.x * by.x - a.y * by.y, a.x * by.y + a.y * by.x};
}

/// The places of a spiral, each with `each` of the area to itself, that lie in the area; at most `count`.
/// Over a long strip hardly any does.
std::vector<Vec2> spiral(const ScatterArea& area, std::size_t count, double each, WorkMeter* meter) {
    const FlatArea& within = area.within;
    const double reach = within.disc ? within.radius : glm::length(0.5 * (within.high - within.low));
    const double step = std::sqrt(each / std::numbers::pi);
    std::vector<Vec2> points;
    Vec2 direction(1, 0);
    for (double i = 0; step * std::sqrt(i + 0.5) <= reach && points.size() < count; ++i) {
        const Vec2 p = within.centre + step * std::sqrt(i + 0.5) * direction;
        count_point(area, meter);
        if (area.contains(p)) points.push_back(p);
        direction = turned(direction, golden_turn);
    }
    return points;
}

} // namespace

bool ScatterArea::contains(Vec2 p) const {
    return within.contains(p) &&
           std::ranges::none_of(without, [&](const FlatArea& area) { return area.contains(p); });
}

double ScatterArea::size(WorkMeter* meter) const {
    if (without.empty()) return within.size();
    int inside = 0, left = 0;
    for (int y = 0; y < samples_a_side; ++y)
        for (int x = 0; x < samples_a_side; ++x) {
            const Vec2 p =
                within.low + (Vec2(x, y) + 0.5) / double{samples_a_side} * (within.high - within.low);
            count_point(*this, meter);
            inside += within.contains(p);
            left += contains(p);
        }
    return inside > 0 ? within.size() * left / inside : 0;
}

double loose_distance(double area_size, std::size_t count) {
    return 0.7 * std::sqrt(area_size / static_cast<double>(count));
}

std::vector<Vec2> poisson_points(const ScatterArea& area, std::size_t count, double apart,
                                 CounterRandom random, WorkMeter* meter) {
    Draws draws(random, meter);
    NearGrid grid(area.within, apart, count);
    throw_darts(area, count, draws, grid);
    if (grid.points().size() < count) fill_gaps(area, count, apart, draws, grid);
    return grid.points();
}

std::vector<Vec2> uniform_points(const ScatterArea& area, std::size_t count, CounterRandom random,
                                 WorkMeter* meter) {
    Draws draws(random, meter);
    std::vector<Vec2> points;
    const double share = area.size(meter) / area.within.size();
    const double most_tries = 100 + 10 * static_cast<double>(count) / share;
    for (double tries = 0; tries < most_tries && points.size() < count; ++tries) {
        const Vec2 p = draws.in(area.within);
        if (draws.lies_in(area, p)) points.push_back(p);
    }
    return points;
}

std::vector<Vec2> jittered_points(const ScatterArea& area, std::size_t count, CounterRandom random,
                                  WorkMeter* meter) {
    const Vec2 extent = area.within.high - area.within.low;
    double cells = static_cast<double>(count) * extent.x * extent.y / area.size(meter);
    for (std::uint64_t attempt = 0; attempt < most_attempts; ++attempt, cells *= 1.02) {
        const std::vector<Vec2> points =
            jittered_lattice(area, cells, Draws(random.sequence(2 * attempt), meter));
        if (points.size() >= count)
            return thinned(points, count, Draws(random.sequence(2 * attempt + 1), meter));
    }
    return {};
}

std::vector<Vec2> spiral_points(const ScatterArea& area, std::size_t count, WorkMeter* meter) {
    double each = area.size(meter) / static_cast<double>(count);
    std::vector<Vec2> points;
    for (int attempt = 0; attempt < most_attempts && points.size() < count; ++attempt, each *= 0.98)
        points = spiral(area, count, each, meter);
    return points;
}

} // namespace graftal
