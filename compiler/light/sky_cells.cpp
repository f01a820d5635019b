#include "compiler/light/sky_cells.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <queue>

#include <glm/geometric.hpp>

namespace graftal {

namespace {

double light_of(const SkyCells::Cell& cell) {
    return (static_cast<double>(cell.power.r) + cell.power.g + cell.power.b) / 3;
}

/// A rectangle of cells and what is in it.
struct Region {
    int left, top, right, bottom; ///< the last two are beyond it
    Rgb power{0.0};
    Vec3 moment{0.0};
    double light = 0;
    unsigned number = 0; ///< of equals, the first is halved first

    /// light * (1 - the mean resultant length of its directions)
    double spread() const { return light - glm::length(moment); }
    bool divisible() const { return right - left > 1 || bottom - top > 1; }

    bool operator<(const Region& other) const {
        return spread() != other.spread() ? spread() < other.spread() : number > other.number;
    }
};

class Cutter {
  public:
    explicit Cutter(const SkyCells& cells) : cells_(cells) {}

    void add(int left, int top, int right, int bottom) {
        Region region{left, top, right, bottom};
        for (int y = top; y < bottom; ++y)
            for (int x = left; x < right; ++x) {
                const SkyCells::Cell& cell = at(x, y);
                region.power += Rgb(cell.power);
                region.moment += Vec3(cell.moment);
                region.light += light_of(cell);
            }
        if (!(region.light > 0)) return;
        region.number = next_number_++;
        if (region.divisible())
            open_.push(region);
        else
            closed_.push_back(region);
    }

    unsigned count() const { return static_cast<unsigned>(open_.size() + closed_.size()); }
    bool finished() const { return open_.empty(); }

    /// Where half of the light lies on either side, or nearly; dark sides are dropped.
    void halve_widest() {
        const Region region = open_.top();
        open_.pop();
        const bool across = width(region) > height(region);
        const int begin = across ? region.left : region.top, end = across ? region.right : region.bottom;
        double before = 0;
        int cut = begin + 1;
        for (; cut < end - 1; ++cut) {
            const double next = line(region, across, cut - 1);
            if (before + next > 0.5 * region.light) {
                // The cut is on the nearer side of the line that holds the middle.
                if (cut - 1 > begin && 0.5 * region.light - before < before + next - 0.5 * region.light)
                    --cut;
                break;
            }
            before += next;
        }
        if (across) {
            add(region.left, region.top, cut, region.bottom);
            add(cut, region.top, region.right, region.bottom);
        } else {
            add(region.left, region.top, region.right, cut);
            add(region.left, cut, region.right, region.bottom);
        }
    }

    std::vector<SkyRegion> regions() && {
        for (; !open_.empty(); open_.pop())
            closed_.push_back(open_.top());
        std::ranges::sort(closed_, {}, &Region::number);
        std::vector<SkyRegion> result;
        for (const Region& region : closed_) {
            const double length = glm::length(region.moment);
            if (length > 0) result.push_back({region.moment / length, length / region.light * region.power});
        }
        return result;
    }

  private:
    const SkyCells::Cell& at(int x, int y) const {
        return cells_.cells[static_cast<std::size_t>(y) * static_cast<std::size_t>(cells_.columns) +
                            static_cast<std::size_t>(x)];
    }

    /// The light of a column or a row of the region.
    double line(const Region& region, bool across, int number) const {
        double light = 0;
        if (across)
            for (int y = region.top; y < region.bottom; ++y)
                light += light_of(at(number, y));
        else
            for (int x = region.left; x < region.right; ++x)
                light += light_of(at(x, number));
        return light;
    }

    double height(const Region& region) const {
        if (region.bottom - region.top < 2) return 0;
        return std::numbers::pi * (region.bottom - region.top) / cells_.rows;
    }
    /// Radians on the sphere, at its middle.
    double width(const Region& region) const {
        if (region.right - region.left < 2) return 0;
        if (region.bottom - region.top < 2) return 2 * std::numbers::pi;
        const double middle = std::numbers::pi * 0.5 * (region.top + region.bottom) / cells_.rows;
        return 2 * std::numbers::pi * (region.right - region.left) / cells_.columns * std::sin(middle);
    }

    const SkyCells& cells_;
    std::priority_queue<Region> open_; ///< regions to halve
    std::vector<Region> closed_;
    unsigned next_number_ = 0;
};

} // namespace

std::vector<SkyRegion> sky_regions(const SkyCells& cells, unsigned count, bool above_only) {
    Cutter cutter(cells);
    cutter.add(0, 0, cells.columns, cells.rows / 2);
    if (!above_only) cutter.add(0, cells.rows / 2, cells.columns, cells.rows);
    while (cutter.count() < count && !cutter.finished())
        cutter.halve_widest();
    return std::move(cutter).regions();
}

} // namespace graftal
