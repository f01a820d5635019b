#include "compiler/import/cfdg/paths/outline.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "compiler/support/number.h"

namespace graftal::cfdg {

namespace {

constexpr std::size_t most_edges = 30'000;
constexpr std::size_t most_ring_corners = 900; ///< of a polygon
constexpr double miter_limit = 4;              ///< of half the width, where a corner becomes blunt
constexpr double round_step_deg = 15;

double cross(Point a, Point b) {
    return a.x * b.y - a.y * b.x;
}

double area(const std::vector<Point>& points) {
    double sum = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
        sum += cross(points[i], points[(i + 1) % points.size()]);
    return sum / 2;
}

/// Without points that repeat; empty if there is no area.
std::vector<Point> ring_of(const Outline& outline, double tiny) {
    std::vector<Point> ring;
    for (const Point point : outline.points)
        if (ring.empty() || glm::distance(ring.back(), point) > tiny) ring.push_back(point);
    while (ring.size() > 1 && glm::distance(ring.front(), ring.back()) <= tiny)
        ring.pop_back();
    if (ring.size() < 3) ring.clear();
    return ring;
}

struct Edge {
    Point low, high;
    int winding = 0;

    double x_at(double y) const { return low.x + (high.x - low.x) * ((y - low.y) / (high.y - low.y)); }
};

class Filler {
  public:
    Filler(std::vector<std::vector<Point>> rings, bool even_odd, double tiny, std::size_t& work)
        : rings_(std::move(rings)), even_odd_(even_odd), tiny_(tiny), left_(work) {}

    std::optional<std::vector<Polygon>> run() {
        if (rings_.empty()) return std::vector<Polygon>();
        if (corners() > most_edges) return std::nullopt;
        if (std::optional<Polygon> all = simple()) return std::vector<Polygon>{std::move(*all)};
        return bands();
    }

    /// One polygon of all rings, where they neither cross nor touch.
    std::optional<Polygon> simple() const {
        if (rings_.empty() || corners() > most_ring_corners || !are_simple()) return std::nullopt;
        if (!even_odd_ && rings_.size() > 1 && !holes_turn()) return std::nullopt;
        Polygon all;
        for (const std::vector<Point>& ring : rings_) {
            all.insert(all.end(), ring.begin(), ring.end());
            all.push_back(ring.front());
        }
        return all;
    }

  private:
    std::size_t corners() const {
        std::size_t sum = 0;
        for (const std::vector<Point>& ring : rings_)
            sum += ring.size();
        return sum;
    }

    /// Whether rings neither cross nor touch, themselves or each other.
    bool are_simple() const {
        struct Side {
            Point a, b;
            std::size_t ring, place;
        };
        std::vector<Side> sides;
        for (std::size_t r = 0; r < rings_.size(); ++r)
            for (std::size_t i = 0; i < rings_[r].size(); ++i)
                sides.push_back({rings_[r][i], rings_[r][(i + 1) % rings_[r].size()], r, i});
        std::ranges::sort(sides, {}, [](const Side& side) { return std::min(side.a.x, side.b.x); });
        for (std::size_t i = 0; i < sides.size(); ++i) {
            const Side& one = sides[i];
            const double right = std::max(one.a.x, one.b.x) + tiny_;
            for (std::size_t j = i + 1; j < sides.size() && std::min(sides[j].a.x, sides[j].b.x) <= right;
                 ++j) {
                if (!spend(1)) return false;
                const Side& other = sides[j];
                const std::size_t size = rings_[one.ring].size();
                const bool same = one.ring == other.ring;
                const bool next = same && (one.place + 1) % size == other.place;
                const bool before = same && (other.place + 1) % size == one.place;
                if (next || before) {
                    const Point shared = next ? one.b : one.a;
                    const Point a = (next ? one.a : one.b) - shared, b = (next ? other.b : other.a) - shared;
                    if (std::abs(cross(a, b)) <= 1e-9 * glm::length(a) * glm::length(b) && glm::dot(a, b) > 0)
                        return false; // folds back
                    continue;
                }
                if (meet(one.a, one.b, other.a, other.b)) return false;
            }
        }
        return true;
    }

    /// Whether two sides come closer than a tiny distance.
    bool meet(Point a, Point b, Point c, Point d) const {
        if (std::max(a.y, b.y) + tiny_ < std::min(c.y, d.y) ||
            std::max(c.y, d.y) + tiny_ < std::min(a.y, b.y))
            return false;
        const auto side = [&](Point from, Point to, Point point) {
            const double length = std::max(glm::distance(from, to), 1e-300);
            const double height = cross(to - from, point - from) / length;
            return height > tiny_ ? 1 : height < -tiny_ ? -1 : 0;
        };
        const int c_side = side(a, b, c), d_side = side(a, b, d), a_side = side(c, d, a),
                  b_side = side(c, d, b);
        if (c_side * d_side > 0 || a_side * b_side > 0) return false;
        return true;
    }

    static bool holds(const std::vector<Point>& ring, Point point) {
        bool inside = false;
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Point a = ring[i], b = ring[(i + 1) % ring.size()];
            if ((a.y > point.y) != (b.y > point.y) &&
                point.x < a.x + (b.x - a.x) * (point.y - a.y) / (b.y - a.y))
                inside = !inside;
        }
        return inside;
    }

    /// Whether windings and odd numbers fill the same: each ring within another turns the other way.
    bool holes_turn() const {
        for (const std::vector<Point>& ring : rings_) {
            int winding = area(ring) > 0 ? 1 : -1, depth = 0;
            for (const std::vector<Point>& other : rings_) {
                if (&other == &ring || !holds(other, ring.front())) continue;
                winding += area(other) > 0 ? 1 : -1;
                ++depth;
            }
            if ((winding != 0) != (depth % 2 == 0)) return false;
        }
        return true;
    }

    std::vector<Edge> edges() const {
        std::vector<Edge> edges;
        for (const std::vector<Point>& ring : rings_)
            for (std::size_t i = 0; i < ring.size(); ++i) {
                const Point a = ring[i], b = ring[(i + 1) % ring.size()];
                if (a.y < b.y) edges.push_back({a, b, 1});
                if (a.y > b.y) edges.push_back({b, a, -1});
            }
        std::ranges::sort(edges, {}, [](const Edge& edge) { return edge.low.y; });
        return edges;
    }

    /// Trapezoids between the heights of all corners and crossings. Those that the same two sides bound are
    /// one.
    std::optional<std::vector<Polygon>> bands() const {
        const std::vector<Edge> edges = this->edges();
        std::vector<double> heights;
        for (const Edge& edge : edges)
            heights.insert(heights.end(), {edge.low.y, edge.high.y});
        for (std::size_t i = 0; i < edges.size(); ++i)
            for (std::size_t j = i + 1; j < edges.size() && edges[j].low.y < edges[i].high.y; ++j) {
                if (!spend(1)) return std::nullopt;
                const Point a = edges[i].high - edges[i].low, b = edges[j].high - edges[j].low;
                const double turn = cross(a, b);
                if (turn == 0) continue;
                const double t = cross(edges[j].low - edges[i].low, b) / turn;
                const double u = cross(edges[j].low - edges[i].low, a) / turn;
                if (t > 0 && t < 1 && u > 0 && u < 1) heights.push_back(edges[i].low.y + t * a.y);
                if (heights.size() > 200'000) return std::nullopt;
            }
        std::ranges::sort(heights);
        struct Open {
            double from, to;
        };
        std::map<std::pair<std::size_t, std::size_t>, Open> open;
        std::vector<Polygon> done;
        const auto close = [&](const auto& entry) {
            const auto& [sides, span] = entry;
            const Edge &left = edges[sides.first], &right = edges[sides.second];
            // Sides that meet in a corner may cross by the last digits.
            const auto across = [&](double y) {
                const double a = left.x_at(y), b = right.x_at(y);
                return a <= b ? std::pair(a, b) : std::pair((a + b) / 2, (a + b) / 2);
            };
            const auto [left_from, right_from] = across(span.from);
            const auto [left_to, right_to] = across(span.to);
            Outline outline{
                {{left_from, span.from}, {right_from, span.from}, {right_to, span.to}, {left_to, span.to}},
                true};
            const double length = span.to - span.from + std::abs(outline.points[1].x - outline.points[0].x);
            if (Polygon ring = ring_of(outline, tiny_);
                !ring.empty() && std::abs(area(ring)) > 2 * tiny_ * length)
                done.push_back(std::move(ring));
        };
        std::vector<std::size_t> active;
        std::size_t next = 0;
        double low = heights.empty() ? 0 : heights.front();
        for (const double high : heights) {
            if (high - low <= tiny_) continue;
            std::erase_if(active, [&](std::size_t id) { return edges[id].high.y <= low + tiny_ / 2; });
            for (; next < edges.size() && edges[next].low.y < low + tiny_ / 2; ++next)
                if (edges[next].high.y > low + tiny_ / 2) active.push_back(next);
            if (!spend(active.size() + 1)) return std::nullopt;
            const double middle = (low + high) / 2;
            std::ranges::sort(active, {},
                              [&](std::size_t id) { return std::pair(edges[id].x_at(middle), id); });
            std::map<std::pair<std::size_t, std::size_t>, Open> still;
            int winding = 0;
            std::size_t left = 0;
            for (const std::size_t id : active) {
                const bool before = fills(winding);
                winding += edges[id].winding;
                if (!before && fills(winding)) left = id;
                if (!before || fills(winding)) continue;
                const std::pair sides(left, id);
                const auto held = open.find(sides);
                still[sides] = {held == open.end() ? low : held->second.from, high};
                if (held != open.end()) open.erase(held);
            }
            for (const auto& entry : open)
                close(entry);
            open = std::move(still);
            low = high;
        }
        for (const auto& entry : open)
            close(entry);
        return done;
    }

    bool spend(std::size_t work) const {
        const bool enough = left_ >= work;
        left_ -= enough ? work : left_;
        return enough;
    }

    bool fills(int winding) const { return even_odd_ ? winding % 2 != 0 : winding != 0; }

    std::vector<std::vector<Point>> rings_;
    bool even_odd_;
    double tiny_;
    std::size_t& left_;
};

/// The distance below which a difference is rounding.
double grain(const std::vector<Outline>& outlines) {
    double most = 0;
    for (const Outline& outline : outlines)
        for (const Point point : outline.points)
            most = std::max({most, std::abs(point.x), std::abs(point.y)});
    return 1e-9 * most;
}

/// A power of two, of which small numbers are multiples to the bit, where coordinates have another size than
/// those that polygon(...) takes.
double unit_of(double most) {
    constexpr double largest = 900, smallest = 1e-3;
    return most > 0 && (most > largest || most < smallest) ? std::exp2(std::floor(std::log2(most))) : 1;
}

Filler filler(const std::vector<Outline>& outlines, bool even_odd, std::size_t& work) {
    const double tiny = grain(outlines);
    std::vector<std::vector<Point>> rings;
    for (const Outline& outline : outlines)
        if (std::vector<Point> ring = ring_of(outline, tiny); !ring.empty()) rings.push_back(std::move(ring));
    return {std::move(rings), even_odd, tiny, work};
}

/// The parts of a stroke, each counter-clockwise, so that windings add up.
class Pen {
  public:
    explicit Pen(const Stroke& stroke) : stroke_(stroke), half_(stroke.width / 2) {}

    void draw(const Outline& outline, double tiny) {
        std::vector<Point> points;
        for (const Point point : outline.points)
            if (points.empty() || glm::distance(points.back(), point) > tiny) points.push_back(point);
        const bool closed = outline.closed && points.size() > 2;
        if (closed && glm::distance(points.front(), points.back()) <= tiny) points.pop_back();
        if (points.size() < 2) return;
        ribbon(points, closed);
        const std::size_t n = points.size(), sides = closed ? n : n - 1;
        for (std::size_t i = 0; i < sides; ++i)
            side(points[i], points[(i + 1) % n]);
        for (std::size_t i = closed ? 0 : 1; i < (closed ? n : n - 1); ++i)
            corner(points[(i + n - 1) % n], points[i], points[(i + 1) % n]);
        if (closed) return;
        cap(points[1], points[0]);
        cap(points[n - 2], points[n - 1]);
    }

    std::vector<Outline> parts;
    std::vector<Outline> ribbons; ///< parts as rings, where the pen does not cross its own way

  private:
    /// Both banks of the way: one ring of an open outline, two of a closed one.
    void ribbon(const std::vector<Point>& points, bool closed) {
        Outline left{{}, true}, right{{}, true};
        const std::size_t n = points.size();
        for (std::size_t i = 0; i < n; ++i) {
            const bool end = !closed && (i == 0 || i + 1 == n);
            const Point a = points[(i + n - 1) % n], b = points[i], c = points[(i + 1) % n];
            if (!end) {
                bend(across(a, b), across(b, c), b, left.points, 1);
                bend(across(a, b), across(b, c), b, right.points, -1);
                continue;
            }
            const Point up = i == 0 ? across(b, c) : across(a, b);
            const Point out = (i == 0 ? -1.0 : 1.0) * Point(up.y, -up.x); // along the way, beyond its end
            const Point tip = stroke_.cap == Cap::square ? b + out : b;
            left.points.push_back(tip + up);
            if (stroke_.cap == Cap::round) {
                std::vector<Point>& last = i == 0 ? right.points : left.points;
                std::vector<Point> arc;
                for (double angle = round_step_deg; angle < 179.9; angle += round_step_deg) {
                    const double t = angle * std::numbers::pi / 180;
                    arc.push_back(b + std::cos(t) * up + std::sin(t) * out);
                }
                if (i == 0) { // the right bank begins behind the arc that ends the ring
                    first_ = arc;
                    std::ranges::reverse(first_);
                } else {
                    last.insert(last.end(), arc.begin(), arc.end());
                }
            }
            right.points.push_back(tip - up);
        }
        if (closed) {
            ribbons.push_back(std::move(left));
            ribbons.push_back(std::move(right));
            return;
        }
        left.points.insert(left.points.end(), right.points.rbegin(), right.points.rend());
        left.points.insert(left.points.end(), first_.begin(), first_.end());
        first_.clear();
        ribbons.push_back(std::move(left));
    }

    /// The points of a bank at a corner.
    void bend(Point before, Point behind, Point at, std::vector<Point>& bank, double side) const {
        const double turn = cross(before, behind) / (half_ * half_),
                     along = glm::dot(before, behind) / (half_ * half_);
        const Point middle = before + behind;
        const double length = glm::length(middle);
        const double miter = length > 0 ? 2 * half_ / length : 1e9; // over half the width
        const bool inner = turn * side > 0;
        const bool smooth = along > std::cos(round_step_deg * std::numbers::pi / 180);
        const bool sharp = !inner && !smooth && (stroke_.join != Join::miter || miter > miter_limit);
        if (!sharp && length > 0) {
            bank.push_back(at + side * middle * (2 * half_ * half_ / glm::dot(middle, middle)));
            return;
        }
        bank.push_back(at + side * before);
        if (stroke_.join == Join::round) {
            const double whole = std::atan2(turn, along);
            const int steps = std::max(
                1, static_cast<int>(std::ceil(std::abs(whole) / (round_step_deg * std::numbers::pi / 180))));
            for (int i = 1; i < steps; ++i) {
                const double t = whole * i / steps, c = std::cos(t), s = std::sin(t);
                bank.push_back(at + side * Point(c * before.x - s * before.y, s * before.x + c * before.y));
            }
        }
        bank.push_back(at + side * behind);
    }

    Point across(Point a, Point b) const {
        const Point along = (b - a) / glm::distance(a, b);
        return {-along.y * half_, along.x * half_};
    }

    void add(std::vector<Point> points) {
        if (area(points) < 0) std::ranges::reverse(points);
        parts.push_back({std::move(points), true});
    }

    void side(Point a, Point b) {
        const Point up = across(a, b);
        add({a - up, b - up, b + up, a + up});
    }

    void disc(Point middle) {
        std::vector<Point> points;
        for (double angle = 0; angle < 359.9; angle += round_step_deg) {
            const double t = angle * std::numbers::pi / 180;
            points.push_back(middle + half_ * Point(std::cos(t), std::sin(t)));
        }
        add(std::move(points));
    }

    void corner(Point a, Point b, Point c) {
        const Point before = across(a, b), behind = across(b, c);
        const double turn = cross(before, behind) / (half_ * half_),
                     along = glm::dot(before, behind) / (half_ * half_);
        if (std::abs(turn) < 1e-6 && along > 0) return;
        if (stroke_.join == Join::round) {
            if (along < std::cos(round_step_deg * std::numbers::pi / 180)) return disc(b);
        }
        const double outer = turn > 0 ? -1 : 1; // the corner is open to the other side of its turn
        const Point from = b + outer * before, to = b + outer * behind;
        const Point middle = before + behind;
        const double length = glm::length(middle);
        const double miter = length > 0 ? 2 * half_ / length : 1e9; // over half the width
        if (stroke_.join != Join::bevel && miter <= miter_limit && length > 0)
            add({b, from, b + outer * middle * (2 * half_ * half_ / glm::dot(middle, middle)), to});
        else
            add({b, from, to});
    }

    void cap(Point from, Point end) {
        if (stroke_.cap == Cap::round) disc(end);
        if (stroke_.cap != Cap::square) return;
        side(end, end + (end - from) * (half_ / glm::distance(from, end)));
    }

    Stroke stroke_;
    double half_;
    std::vector<Point> first_; ///< the arc of a round cap at the beginning
};

} // namespace

std::optional<std::vector<Polygon>> filled(const std::vector<Outline>& outlines, bool even_odd,
                                           std::size_t& work) {
    return filler(outlines, even_odd, work).run();
}

std::optional<std::vector<Polygon>> stroked(const std::vector<Outline>& outlines, const Stroke& stroke,
                                            std::size_t& work) {
    Pen pen(stroke);
    const double tiny = grain(outlines);
    for (const Outline& outline : outlines) {
        pen.draw(outline, tiny);
        if (pen.parts.size() > most_edges) return std::nullopt;
    }
    if (std::optional<Polygon> ribbon = filler(pen.ribbons, true, work).simple())
        return std::vector<Polygon>{std::move(*ribbon)};
    return filled(pen.parts, false, work);
}

std::string polygon_text(const Polygon& polygon) {
    double most = 0;
    for (const Point point : polygon)
        most = std::max({most, std::abs(point.x), std::abs(point.y)});
    const double unit = unit_of(most);
    std::string text;
    for (const Point point : polygon)
        text += fmt::format("{}{}, {}", text.empty() ? "" : ", ", shortest(point.x / unit),
                            shortest(point.y / unit));
    return fmt::format("instance: polygon({}){}", text, unit == 1 ? "" : "  scale: " + shortest(unit));
}

} // namespace graftal::cfdg
