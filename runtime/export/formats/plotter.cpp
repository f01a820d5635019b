#include "runtime/export/formats/plotter.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <unordered_map>

namespace graftal {

namespace {

using PenCell = std::array<std::int64_t, 2>;

struct PenCellHash {
    std::size_t operator()(const PenCell& cell) const {
        return static_cast<std::size_t>(cell[0]) * 0x9E3779B97F4A7C15ull ^
               static_cast<std::size_t>(cell[1]) * 0xC2B2AE3D27D4EB4Full;
    }
};

double pen_distance(const Point2& a, const Point2& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1]);
}

/// The ends of strokes by cells of a grid, about one a cell.
class StrokeEnds {
  public:
    StrokeEnds(const std::vector<PenStroke>& strokes, double cell) : strokes_(strokes), cell_(cell) {
        for (std::size_t i = 0; i < strokes.size(); ++i)
            for (const bool last : {false, true})
                cells_[cell_of(end(i, last))].push_back({i, last});
        left_ = strokes.size();
        low_ = {INT64_MAX, INT64_MAX};
        high_ = {INT64_MIN, INT64_MIN};
        for (const auto& [key, ends] : cells_)
            for (std::size_t axis = 0; axis < 2; ++axis) {
                low_[axis] = std::min(low_[axis], key[axis]);
                high_[axis] = std::max(high_[axis], key[axis]);
            }
    }

    struct End {
        std::size_t stroke = 0;
        bool last = false;
    };

    bool empty() const { return left_ == 0; }

    /// The nearest end; of equally near ones the first. Requires that one is left.
    End nearest(const Point2& from) const {
        const PenCell centre = cell_of(from);
        End best;
        double least = HUGE_VAL;
        const std::int64_t most = std::max({centre[0] - low_[0], high_[0] - centre[0], centre[1] - low_[1],
                                            high_[1] - centre[1], std::int64_t{0}});
        for (std::int64_t ring = 0; ring <= most && least > static_cast<double>(ring - 1) * cell_; ++ring)
            for (std::int64_t x = -ring; x <= ring; ++x) {
                const bool side = x == -ring || x == ring;
                for (std::int64_t y = -ring; y <= ring; y += side || ring == 0 ? 1 : 2 * ring)
                    look({centre[0] + x, centre[1] + y}, from, best, least);
            }
        return best;
    }

    void take(std::size_t stroke) {
        for (const bool last : {false, true})
            std::erase_if(cells_[cell_of(end(stroke, last))],
                          [&](const End& candidate) { return candidate.stroke == stroke; });
        --left_;
    }

  private:
    const Point2& end(std::size_t stroke, bool last) const {
        return last ? strokes_[stroke].back() : strokes_[stroke].front();
    }

    PenCell cell_of(const Point2& p) const {
        return {static_cast<std::int64_t>(std::floor(p[0] / cell_)),
                static_cast<std::int64_t>(std::floor(p[1] / cell_))};
    }

    void look(const PenCell& cell, const Point2& from, End& best, double& least) const {
        const auto known = cells_.find(cell);
        if (known == cells_.end()) return;
        for (const End& candidate : known->second) {
            const double away = pen_distance(from, end(candidate.stroke, candidate.last));
            const bool earlier = candidate.stroke < best.stroke ||
                                 (candidate.stroke == best.stroke && !candidate.last && best.last);
            if (away < least || (away == least && earlier)) {
                least = away;
                best = candidate;
            }
        }
    }

    const std::vector<PenStroke>& strokes_;
    double cell_;
    std::unordered_map<PenCell, std::vector<End>, PenCellHash> cells_;
    PenCell low_{}, high_{};
    std::size_t left_ = 0;
};

/// Points in whole tolerances: what is equal in these is one.
std::vector<PenCell> rounded_points(const PenStroke& stroke, double tolerance) {
    std::vector<PenCell> points;
    for (const Point2& p : stroke)
        points.push_back({std::llround(p[0] / tolerance), std::llround(p[1] / tolerance)});
    return points;
}

} // namespace

std::vector<PenStroke> pen_path(std::vector<PenStroke> strokes, double tolerance) {
    std::set<std::vector<PenCell>> drawn;
    std::erase_if(strokes, [&](const PenStroke& stroke) {
        if (stroke.empty()) return true;
        std::vector<PenCell> there = rounded_points(stroke, tolerance), back = there;
        std::ranges::reverse(back);
        return !drawn.insert(std::min(there, back)).second;
    });
    if (strokes.empty()) return strokes;
    Point2 low = strokes.front().front(), high = low;
    for (const PenStroke& stroke : strokes)
        for (const Point2& p : stroke)
            for (std::size_t axis = 0; axis < 2; ++axis) {
                low[axis] = std::min(low[axis], p[axis]);
                high[axis] = std::max(high[axis], p[axis]);
            }
    const double extent = std::max(high[0] - low[0], high[1] - low[1]);
    const double cell = std::max(extent / std::sqrt(static_cast<double>(strokes.size())), tolerance);
    StrokeEnds ends(strokes, cell);
    std::vector<PenStroke> path;
    Point2 pen = low;
    while (!ends.empty()) {
        const StrokeEnds::End next = ends.nearest(pen);
        ends.take(next.stroke);
        PenStroke stroke = strokes[next.stroke];
        if (next.last) std::ranges::reverse(stroke);
        pen = stroke.back();
        if (!path.empty() && pen_distance(path.back().back(), stroke.front()) <= tolerance)
            path.back().insert(path.back().end(), stroke.begin() + 1, stroke.end());
        else
            path.push_back(std::move(stroke));
    }
    return path;
}

double lifted_length(const std::vector<PenStroke>& strokes) {
    double length = 0;
    for (std::size_t i = 1; i < strokes.size(); ++i)
        length += pen_distance(strokes[i - 1].back(), strokes[i].front());
    return length;
}

} // namespace graftal
