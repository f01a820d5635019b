#include "runtime/image/distance_transform.h"

#include <algorithm>
#include <cmath>

namespace graftal {

namespace {

constexpr std::int64_t nowhere = -1;

/// Down each column: the distance to the nearest cell of the set in it.
std::vector<std::int64_t> column_distances(const CellSet& set) {
    std::vector<std::int64_t> distance(set.cells.size(), nowhere);
    for (int z = 0; z < set.depth; ++z)
        for (int x = 0; x < set.width; ++x) {
            const auto sweep = [&](int first, int last, int step) {
                std::int64_t since = nowhere;
                for (int y = first; y != last; y += step) {
                    since = set.at(x, y, z) ? 0 : since == nowhere ? nowhere : since + 1;
                    std::int64_t& here = distance[set.index(x, y, z)];
                    if (since != nowhere && (here == nowhere || since < here)) here = since;
                }
            };
            sweep(0, set.height, 1);
            sweep(set.height - 1, -1, -1);
        }
    return distance;
}

/// The lower envelope of the parabolas (x - at)^2 + base along a row.
class Envelope {
  public:
    void clear() { parabolas_.clear(); }

    void add(int at, std::int64_t base) {
        double from = -1e300;
        while (!parabolas_.empty()) {
            const Parabola& last = parabolas_.back();
            // Where the new one comes to lie below.
            from = static_cast<double>(base + std::int64_t{at} * at - last.base -
                                       std::int64_t{last.at} * last.at) /
                   (2.0 * (at - last.at));
            if (from > last.from) break;
            parabolas_.pop_back();
            from = -1e300;
        }
        parabolas_.push_back({at, base, from});
    }

    template<typename Put> void walk(int width, const Put& put) const {
        std::size_t i = 0;
        for (int x = 0; x < width && !parabolas_.empty(); ++x) {
            while (i + 1 < parabolas_.size() && parabolas_[i + 1].from < x)
                ++i;
            const std::int64_t away = x - parabolas_[i].at;
            put(x, parabolas_[i].at, away * away + parabolas_[i].base);
        }
    }

  private:
    struct Parabola {
        int at;
        std::int64_t base;
        double from;
    };

    std::vector<Parabola> parabolas_;
};

/// Calls put(cell, nearest, squared) for each cell: a nearest cell of the set.
template<typename Put> void for_each_nearest(const CellSet& set, const Put& put) {
    std::vector<std::int64_t> squared = column_distances(set);
    std::vector<std::size_t> nearest(set.depth > 1 ? set.cells.size() : 0);
    std::vector<std::int64_t> down(static_cast<std::size_t>(set.width));
    Envelope envelope;
    for (int z = 0; z < set.depth; ++z)
        for (int y = 0; y < set.height; ++y) {
            envelope.clear();
            for (int x = 0; x < set.width; ++x) {
                const std::int64_t away = down[static_cast<std::size_t>(x)] = squared[set.index(x, y, z)];
                if (away != nowhere) envelope.add(x, away * away);
            }
            envelope.walk(set.width, [&](int x, int at, std::int64_t value) {
                const int away = static_cast<int>(down[static_cast<std::size_t>(at)]);
                const bool above = y - away >= 0 && set.at(at, y - away, z);
                const std::size_t cell = set.index(x, y, z),
                                  found = set.index(at, above ? y - away : y + away, z);
                if (set.depth == 1) return put(cell, found, value);
                squared[cell] = value;
                nearest[cell] = found;
            });
        }
    if (set.depth == 1) return;
    for (int y = 0; y < set.height; ++y)
        for (int x = 0; x < set.width; ++x) {
            envelope.clear();
            for (int z = 0; z < set.depth; ++z)
                if (const std::int64_t there = squared[set.index(x, y, z)]; there != nowhere)
                    envelope.add(z, there);
            envelope.walk(set.depth, [&](int z, int at, std::int64_t value) {
                put(set.index(x, y, z), nearest[set.index(x, y, at)], value);
            });
        }
}

} // namespace

std::vector<std::int64_t> squared_distances(const CellSet& set) {
    std::vector<std::int64_t> squared(set.cells.size());
    for_each_nearest(set, [&](std::size_t cell, std::size_t, std::int64_t value) { squared[cell] = value; });
    return squared;
}

std::vector<std::size_t> nearest_cells(const CellSet& set) {
    std::vector<std::size_t> nearest(set.cells.size());
    for_each_nearest(set, [&](std::size_t cell, std::size_t found, std::int64_t) { nearest[cell] = found; });
    return nearest;
}

double farthest(const CellSet& from, const std::vector<std::int64_t>& squared) {
    std::int64_t most = 0;
    for (std::size_t i = 0; i < from.cells.size(); ++i)
        if (from.cells[i]) most = std::max(most, squared[i]);
    return std::sqrt(static_cast<double>(most));
}

double hausdorff_distance(const CellSet& a, const CellSet& b) {
    return std::max(farthest(a, squared_distances(b)), farthest(b, squared_distances(a)));
}

} // namespace graftal
