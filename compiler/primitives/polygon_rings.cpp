#include "compiler/primitives/polygon_rings.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

namespace graftal {

namespace {

/// Twice the area of a triangle, positive if it goes round counter-clockwise.
double turn(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

bool between(const PlanePoint& a, const PlanePoint& b, const PlanePoint& p) {
    return std::min(a[0], b[0]) <= p[0] && p[0] <= std::max(a[0], b[0]) && std::min(a[1], b[1]) <= p[1] &&
           p[1] <= std::max(a[1], b[1]);
}

/// Whether two segments have a point in common.
bool meet(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c, const PlanePoint& d) {
    const double abc = turn(a, b, c), abd = turn(a, b, d), cda = turn(c, d, a), cdb = turn(c, d, b);
    if (((abc > 0 && abd < 0) || (abc < 0 && abd > 0)) && ((cda > 0 && cdb < 0) || (cda < 0 && cdb > 0)))
        return true;
    return (abc == 0 && between(a, b, c)) || (abd == 0 && between(a, b, d)) ||
           (cda == 0 && between(c, d, a)) || (cdb == 0 && between(c, d, b));
}

struct Ring {
    std::uint32_t first, end;

    std::uint32_t next(std::uint32_t i) const { return i + 1 == end ? first : i + 1; }
};

std::vector<Ring> list_of(const PolygonRings& rings) {
    std::vector<Ring> list;
    std::uint32_t first = 0;
    for (const std::uint32_t end : rings.ring_ends) {
        list.push_back({first, end});
        first = end;
    }
    return list;
}

double area_of(const PolygonRings& rings, const Ring& ring) {
    double sum = 0;
    for (std::uint32_t i = ring.first; i < ring.end; ++i)
        sum += turn(rings.corners[ring.first], rings.corners[i], rings.corners[ring.next(i)]);
    return sum / 2;
}

bool holds(const PolygonRings& rings, const Ring& ring, const PlanePoint& p) {
    bool inside = false;
    for (std::uint32_t i = ring.first; i < ring.end; ++i) {
        const PlanePoint &a = rings.corners[i], &b = rings.corners[ring.next(i)];
        if ((a[1] > p[1]) != (b[1] > p[1]) && p[0] < a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
            inside = !inside;
    }
    return inside;
}

/// One outer ring with its holes, cut into triangles by ears.
class EarClipper {
  public:
    EarClipper(const PolygonRings& rings, std::vector<std::array<std::uint32_t, 3>>& triangles)
        : corners_(rings.corners), triangles_(triangles) {}

    /// Counter-clockwise for the outer ring, clockwise for holes.
    static std::vector<std::uint32_t> loop(const PolygonRings& rings, const Ring& ring, bool outer) {
        std::vector<std::uint32_t> indices(ring.end - ring.first);
        std::iota(indices.begin(), indices.end(), ring.first);
        if ((area_of(rings, ring) > 0) != outer) std::ranges::reverse(indices);
        return indices;
    }

    void run(std::vector<std::uint32_t> outer, std::vector<std::vector<std::uint32_t>> holes) {
        const auto rightmost = [&](const std::vector<std::uint32_t>& hole) {
            return std::ranges::max_element(hole, {}, [&](std::uint32_t i) { return corners_[i]; });
        };
        // The hole that lies farthest to the right sees the ring.
        std::ranges::sort(holes, [&](const auto& a, const auto& b) {
            return corners_[*rightmost(a)] > corners_[*rightmost(b)];
        });
        for (std::size_t h = 0; h < holes.size(); ++h) {
            std::vector<std::uint32_t>& hole = holes[h];
            std::rotate(hole.begin(), std::ranges::find(hole, *rightmost(hole)), hole.end());
            const std::size_t at = bridge(outer, hole.front(), std::span(holes).subspan(h));
            std::vector<std::uint32_t> joined(outer.begin(),
                                              outer.begin() + static_cast<std::ptrdiff_t>(at) + 1);
            joined.insert(joined.end(), hole.begin(), hole.end());
            joined.push_back(hole.front());
            joined.insert(joined.end(), outer.begin() + static_cast<std::ptrdiff_t>(at), outer.end());
            outer = std::move(joined);
        }
        clip(std::move(outer));
    }

  private:
    /// The place in the ring of the nearest corner that a corner of a hole sees.
    std::size_t bridge(const std::vector<std::uint32_t>& outer, std::uint32_t from,
                       std::span<const std::vector<std::uint32_t>> holes) const {
        const PlanePoint& m = corners_[from];
        std::vector<std::size_t> nearest(outer.size());
        std::iota(nearest.begin(), nearest.end(), std::size_t{0});
        const auto distance = [&](std::size_t i) {
            return std::hypot(corners_[outer[i]][0] - m[0], corners_[outer[i]][1] - m[1]);
        };
        std::ranges::stable_sort(nearest, {}, distance);
        for (const std::size_t i : nearest) {
            if (!opens_towards(outer, i, m) || crosses(outer, from, outer[i])) continue;
            if (std::ranges::none_of(holes, [&](const auto& hole) { return crosses(hole, from, outer[i]); }))
                return i;
        }
        return nearest.front();
    }

    /// Whether the ring's inside lies towards the point, seen from a corner of it.
    bool opens_towards(const std::vector<std::uint32_t>& ring, std::size_t i, const PlanePoint& p) const {
        const PlanePoint& a = corners_[ring[(i + ring.size() - 1) % ring.size()]];
        const PlanePoint& b = corners_[ring[i]];
        const PlanePoint& c = corners_[ring[(i + 1) % ring.size()]];
        const bool left_of_in = turn(a, b, p) > 0, left_of_out = turn(b, c, p) > 0;
        return turn(a, b, c) > 0 ? left_of_in && left_of_out : left_of_in || left_of_out;
    }

    /// Whether a segment between two corners meets a side of the ring that begins and ends elsewhere.
    bool crosses(const std::vector<std::uint32_t>& ring, std::uint32_t from, std::uint32_t to) const {
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const std::uint32_t a = ring[i], b = ring[(i + 1) % ring.size()];
            if (a == from || b == from || a == to || b == to) continue;
            if (meet(corners_[from], corners_[to], corners_[a], corners_[b])) return true;
        }
        return false;
    }

    bool is_ear(const std::vector<std::uint32_t>& ring, std::size_t i) const {
        const std::uint32_t a = ring[(i + ring.size() - 1) % ring.size()], b = ring[i],
                            c = ring[(i + 1) % ring.size()];
        if (!(turn(corners_[a], corners_[b], corners_[c]) > 0)) return false;
        return std::ranges::none_of(ring, [&](std::uint32_t other) {
            if (other == a || other == b || other == c) return false;
            const PlanePoint& p = corners_[other];
            return turn(corners_[a], corners_[b], p) >= 0 && turn(corners_[b], corners_[c], p) >= 0 &&
                   turn(corners_[c], corners_[a], p) >= 0;
        });
    }

    void clip(std::vector<std::uint32_t> ring) {
        std::size_t i = 0, looked = 0;
        while (ring.size() >= 3) {
            i %= ring.size();
            // Where rounding leaves no ear, what goes on straight ahead is one without an area.
            const bool stuck = looked > ring.size();
            const std::size_t before = (i + ring.size() - 1) % ring.size(), after = (i + 1) % ring.size();
            if (!stuck && !is_ear(ring, i)) {
                ++i;
                ++looked;
                continue;
            }
            if (turn(corners_[ring[before]], corners_[ring[i]], corners_[ring[after]]) > 0)
                triangles_.push_back({ring[before], ring[i], ring[after]});
            ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(i));
            looked = 0;
            i = i > 0 ? i - 1 : 0;
        }
    }

    const std::vector<PlanePoint>& corners_;
    std::vector<std::array<std::uint32_t, 3>>& triangles_;
};

bool check_sides(const PolygonRings& rings, std::string& fault) {
    const std::vector<Ring> list = list_of(rings);
    std::vector<std::array<std::uint32_t, 2>> sides;
    for (const Ring& ring : list)
        for (std::uint32_t i = ring.first; i < ring.end; ++i)
            sides.push_back({i, ring.next(i)});
    for (std::size_t i = 0; i < sides.size(); ++i)
        for (std::size_t j = i + 1; j < sides.size(); ++j) {
            const auto [a, b] = sides[i];
            const auto [c, d] = sides[j];
            const PlanePoint &pa = rings.corners[a], &pb = rings.corners[b], &pc = rings.corners[c],
                             &pd = rings.corners[d];
            bool bad = false;
            if (b == c || a == d) { // neighbours share a corner, and must not fold back
                const PlanePoint &tip = b == c ? pb : pa, &one = b == c ? pa : pb, &other = b == c ? pd : pc;
                bad = turn(one, tip, other) == 0 &&
                      (one[0] - tip[0]) * (other[0] - tip[0]) + (one[1] - tip[1]) * (other[1] - tip[1]) > 0;
            } else {
                bad = meet(pa, pb, pc, pd);
            }
            if (!bad) continue;
            fault = fmt::format("the outline of the polygon meets itself between corners {} and {}", a + 1,
                                c + 1);
            return false;
        }
    return true;
}

} // namespace

std::optional<PolygonRings> polygon_rings(std::span<const PlanePoint> points, std::string& fault) {
    PolygonRings rings;
    std::uint32_t first = 0;
    const auto close = [&] {
        const auto end = static_cast<std::uint32_t>(rings.corners.size());
        if (end - first < 3) {
            fault = "an outline of a polygon has three corners or more";
            return false;
        }
        rings.ring_ends.push_back(end);
        first = end;
        return true;
    };
    for (const PlanePoint& point : points) {
        if (rings.corners.size() > first && point == rings.corners[first]) {
            if (!close()) return std::nullopt;
            continue;
        }
        if (rings.corners.size() > first && point == rings.corners.back()) {
            fault = "two corners of the polygon that follow each other are one point";
            return std::nullopt;
        }
        rings.corners.push_back(point);
    }
    if (rings.corners.size() > first && !close()) return std::nullopt;
    for (const Ring& ring : list_of(rings))
        if (!(std::abs(area_of(rings, ring)) > 0)) {
            fault = "an outline of the polygon has no area";
            return std::nullopt;
        }
    if (!check_sides(rings, fault)) return std::nullopt;
    return rings;
}

std::vector<std::array<std::uint32_t, 3>> triangulate(const PolygonRings& rings) {
    const std::vector<Ring> list = list_of(rings);
    std::vector<std::vector<std::size_t>> around(list.size()); // rings that hold each ring
    for (std::size_t i = 0; i < list.size(); ++i)
        for (std::size_t j = 0; j < list.size(); ++j)
            if (i != j && holds(rings, list[j], rings.corners[list[i].first])) around[i].push_back(j);
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::size_t i = 0; i < list.size(); ++i) {
        if (around[i].size() % 2 == 1) continue; // a hole
        std::vector<std::vector<std::uint32_t>> holes;
        for (std::size_t j = 0; j < list.size(); ++j)
            if (around[j].size() == around[i].size() + 1 && std::ranges::count(around[j], i) == 1)
                holes.push_back(EarClipper::loop(rings, list[j], false));
        EarClipper(rings, triangles).run(EarClipper::loop(rings, list[i], true), std::move(holes));
    }
    return triangles;
}

} // namespace graftal
