#include "runtime/export/formats/plotter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <queue>
#include <set>

namespace graftal {

namespace {

double pen_distance(const Point2& a, const Point2& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1]);
}

/// The ends of strokes in a tree of boxes, each cut in the middle of its ends: however they are spread, it is
/// as deep as the logarithm of their number.
class StrokeEnds {
  public:
    explicit StrokeEnds(const std::vector<PenStroke>& strokes) : strokes_(strokes), left_(strokes.size()) {
        for (std::size_t i = 0; i < strokes.size(); ++i)
            for (const bool last : {false, true})
                ends_.push_back({i, last});
        leaf_of_.resize(ends_.size());
        grow(0, ends_.size(), nowhere);
    }

    struct End {
        std::size_t stroke = 0;
        bool last = false;
    };

    bool empty() const { return left_ == 0; }

    /// The nearest end; of equally near ones the first. Requires that one is left.
    End nearest(const Point2& from) const {
        Found found;
        // The nearest boxes first: one whose ends near the pen are taken holds up no other.
        std::priority_queue<Waiting, std::vector<Waiting>, std::greater<>> waiting;
        const auto wait = [&](std::size_t number_of_node) {
            const Node& node = nodes_[number_of_node];
            if (node.left > 0) waiting.push({distance(node, from), node.first, number_of_node});
        };
        wait(0);
        constexpr double rounding = 1 + 1e-12;
        for (; !waiting.empty() && waiting.top().distance <= rounding * found.distance;) {
            const Waiting at = waiting.top();
            waiting.pop();
            const Node& node = nodes_[at.node];
            // Many ends may be one point.
            if (node.low == node.high && at.distance >= found.distance && at.first > number(found.end))
                continue;
            if (node.halves[0] != nowhere) {
                wait(node.halves[0]);
                wait(node.halves[1]);
                continue;
            }
            for (std::size_t i = node.begin; i < node.end; ++i)
                if (!taken_[ends_[i].stroke]) look_at(ends_[i], from, found);
        }
        return found.end;
    }

    /// Requires that the stroke is left.
    void take(std::size_t stroke) {
        for (const bool last : {false, true})
            for (std::size_t node = leaf_of_[number({stroke, last})]; node != nowhere;
                 node = nodes_[node].parent)
                --nodes_[node].left;
        taken_[stroke] = true;
        --left_;
    }

  private:
    static constexpr std::size_t nowhere = SIZE_MAX, ends_of_leaf = 8;

    struct Node {
        std::size_t begin = 0, end = 0; ///< of ends_
        std::size_t parent = nowhere;
        std::array<std::size_t, 2> halves{nowhere, nowhere}; ///< none in a leaf
        Point2 low{}, high{};
        std::size_t left = 0;  ///< ends in it that are not taken
        std::size_t first = 0; ///< the least number of its ends
    };
    struct Found {
        End end;
        double distance = HUGE_VAL;
    };
    struct Waiting {
        double distance = 0;
        std::size_t first = 0, node = 0;
        auto operator<=>(const Waiting&) const = default; // NOLINT: clang 14 sees a null pointer here
    };

    static std::size_t number(const End& end) { return 2 * end.stroke + (end.last ? 1 : 0); }

    const Point2& place(const End& end) const {
        return end.last ? strokes_[end.stroke].back() : strokes_[end.stroke].front();
    }

    /// A node of these ends, whose number it returns.
    std::size_t grow(std::size_t begin, std::size_t end, std::size_t parent) {
        const std::size_t made = nodes_.size();
        Node node;
        node.begin = begin;
        node.end = end;
        node.parent = parent;
        node.low = node.high = place(ends_[begin]);
        node.left = end - begin;
        node.first = number(ends_[begin]);
        for (std::size_t i = begin; i < end; ++i) {
            node.first = std::min(node.first, number(ends_[i]));
            for (std::size_t axis = 0; axis < 2; ++axis) {
                node.low[axis] = std::min(node.low[axis], place(ends_[i])[axis]);
                node.high[axis] = std::max(node.high[axis], place(ends_[i])[axis]);
            }
        }
        nodes_.push_back(node);
        if (end - begin <= ends_of_leaf) {
            for (std::size_t i = begin; i < end; ++i)
                leaf_of_[number(ends_[i])] = made;
            return made;
        }
        const std::size_t axis = node.high[0] - node.low[0] < node.high[1] - node.low[1] ? 1 : 0;
        const std::size_t middle = begin + (end - begin) / 2;
        const auto at = [&](std::size_t i) { return ends_.begin() + static_cast<std::ptrdiff_t>(i); };
        std::nth_element(at(begin), at(middle), at(end), [&](const End& a, const End& b) {
            return place(a)[axis] != place(b)[axis] ? place(a)[axis] < place(b)[axis] : number(a) < number(b);
        });
        const std::size_t first = grow(begin, middle, made), second = grow(middle, end, made);
        nodes_[made].halves = {first, second};
        return made;
    }

    double distance(const Node& node, const Point2& from) const {
        Point2 away{};
        for (std::size_t axis = 0; axis < 2; ++axis)
            away[axis] = std::max({node.low[axis] - from[axis], from[axis] - node.high[axis], 0.0});
        return std::hypot(away[0], away[1]);
    }

    void look_at(const End& end, const Point2& from, Found& found) const {
        const double away = pen_distance(from, place(end));
        if (away < found.distance || (away == found.distance && number(end) < number(found.end)))
            found = {end, away};
    }

    const std::vector<PenStroke>& strokes_;
    std::vector<End> ends_;
    std::vector<std::size_t> leaf_of_; ///< by the number of an end
    std::vector<Node> nodes_;          ///< the whole first
    std::vector<bool> taken_ = std::vector<bool>(strokes_.size(), false);
    std::size_t left_;
};

/// Points in whole tolerances: what is equal in these is one.
std::vector<Point2> rounded_points(const PenStroke& stroke, double tolerance) {
    std::vector<Point2> points;
    for (const Point2& p : stroke)
        points.push_back({std::round(p[0] / tolerance), std::round(p[1] / tolerance)});
    return points;
}

} // namespace

std::vector<PenStroke> pen_path(std::vector<PenStroke> strokes, double tolerance) {
    std::set<std::vector<Point2>> drawn;
    std::erase_if(strokes, [&](const PenStroke& stroke) {
        if (stroke.empty()) return true;
        std::vector<Point2> there = rounded_points(stroke, tolerance), back = there;
        std::ranges::reverse(back);
        return !drawn.insert(std::min(there, back)).second;
    });
    if (strokes.empty()) return strokes;
    Point2 low = strokes.front().front();
    for (const PenStroke& stroke : strokes)
        for (const Point2& p : stroke)
            for (std::size_t axis = 0; axis < 2; ++axis)
                low[axis] = std::min(low[axis], p[axis]);
    StrokeEnds ends(strokes);
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
