#include "compiler/detail/shadow/shadow.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>

#include "compiler/primitives/primitive_cache.h"
#include "compiler/support/check.h"

namespace graftal {

namespace {

using std::numbers::pi;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The least integer that is not below a number within the range of int; what std::ceil gives, which is a
/// call of the library.
int ceiling(double x) {
    const int whole = static_cast<int>(x);
    return whole + (whole < x);
}

/// std::popcount, which is a call of the library too where the processor's instruction may be missing.
int count_ones(std::uint64_t word) {
    word -= word >> 1 & 0x5555555555555555;
    word = (word & 0x3333333333333333) + (word >> 2 & 0x3333333333333333);
    word = (word + (word >> 4)) & 0x0F0F0F0F0F0F0F0F;
    return static_cast<int>(word * 0x0101010101010101 >> 56);
}

const std::vector<ConvexPart>& convex_parts(const Primitive& primitive) {
    static PrimitiveCache<std::vector<ConvexPart>> parts;
    return parts.get(primitive, [&] { return traits_of(primitive).convex_parts(primitive); });
}

} // namespace

double projected_area(const Affine& place, Vec3 direction) {
    // |det L| |L^-1 d| = |adj(L) d|; the rows of the adjugate are products of columns.
    const Mat3& l = place.linear;
    return pi * glm::length(Vec3(glm::dot(glm::cross(l[1], l[2]), direction),
                                 glm::dot(glm::cross(l[2], l[0]), direction),
                                 glm::dot(glm::cross(l[0], l[1]), direction)));
}

Shadow::Shadow(int size) : size_(size), covered_(static_cast<std::size_t>(size) * size / 64, 0) {
    GRAFTAL_CHECK(size > 0 && size % 64 == 0, "shadow: rows are made of words");
    // The golden section spreads the offsets evenly over any few rows that follow each other.
    for (int row = 0; row < size; ++row)
        offset_.push_back(std::fmod((row + 1) * std::numbers::phi, 1.0));
}

void Shadow::start(Vec3 direction, const Ball& ball) {
    std::fill(covered_.begin(), covered_.end(), 0);
    direction_ = direction;
    // Any axis across, but none that straight models are likely to run along.
    right_ = glm::normalize(glm::cross(direction, Vec3(0.26, 0.79, 0.55)));
    up_ = glm::cross(right_, direction);
    centre_ = ball.centre;
    unit_ = 0.5 * size_ / std::max(ball.radius, 1e-280);
}

double Shadow::depth(Vec3 point) const {
    return glm::dot(point - centre_, direction_);
}

Shadow::Point Shadow::project(Vec3 point) const {
    const Vec3 from_centre = point - centre_;
    return {glm::dot(from_centre, right_) * unit_ + 0.5 * size_,
            glm::dot(from_centre, up_) * unit_ + 0.5 * size_};
}

/// False for a point far from the grid, or without a place. Without this test, all would become a single
/// point.
bool Shadow::is_near(const Point& point) {
    constexpr double far = 1e15;
    return std::abs(point.x) < far && std::abs(point.y) < far;
}

int Shadow::first_row(double y) const {
    return ceiling(std::clamp(y - 0.5, 0.0, static_cast<double>(size_)));
}

/// Covers the samples of a row in [from, to).
void Shadow::cover_row(int row, double from, double to, Cover& cover) {
    const double offset = offset_[static_cast<std::size_t>(row)];
    const auto sample = [&](double x) {
        return ceiling(std::clamp(x - offset, 0.0, static_cast<double>(size_)));
    };
    if (!(from < to)) return;
    const int begin = sample(from), end = sample(to);
    if (begin >= end) return;
    cover.samples += end - begin;
    std::uint64_t* const words = covered_.data() + static_cast<std::ptrdiff_t>(row) * (size_ / 64);
    for (int word = begin / 64; word <= (end - 1) / 64; ++word) {
        const int low = std::max(begin - 64 * word, 0), high = std::min(end - 64 * word, 64);
        const std::uint64_t mask = (high == 64 ? ~0ull : (1ull << high) - 1) & ~((1ull << low) - 1);
        const std::uint64_t uncovered = mask & ~words[word];
        if (uncovered == 0) continue;
        cover.uncovered += count_ones(uncovered);
        words[word] |= uncovered;
    }
}

Shadow::Cover Shadow::draw_sphere(const Affine& place) {
    // The shadow is the ellipse centre + B x, |x| <= 1, of which S = B B^T.
    ++bodies_drawn_;
    const Vec3 across = glm::transpose(place.linear) * right_ * unit_;
    const Vec3 upward = glm::transpose(place.linear) * up_ * unit_;
    const double syy = glm::dot(upward, upward), sxy = glm::dot(across, upward);
    const double root = glm::length(glm::cross(across, upward)); // of det S
    Cover cover;
    cover.area = pi * root;
    const Point centre = project(place.translation);
    if (!(syy > 0) || !(root > 0) || !is_near(centre) || !(syy < infinity)) return cover;
    const double half_height = std::sqrt(syy);
    const int end = first_row(centre.y + half_height);
    for (int row = first_row(centre.y - half_height); row < end; ++row) {
        const double y = row + 0.5 - centre.y;
        const double half_width = root / syy * std::sqrt(std::max(syy - y * y, 0.0));
        const double middle = centre.x + sxy / syy * y;
        cover_row(row, middle - half_width, middle + half_width, cover);
    }
    return cover;
}

Shadow::Cover Shadow::draw(const Primitive& primitive, const Affine& place) {
    if (primitive == PrimitiveKind::sphere) return draw_sphere(place);
    Cover sum;
    for (const ConvexPart& part : convex_parts(primitive)) {
        const Cover cover = draw_hull(part.corners, part.ring, place);
        sum.area += cover.area;
        sum.samples += cover.samples;
        sum.uncovered += cover.uncovered;
    }
    return sum;
}

std::size_t Shadow::bodies_of(const Primitive& primitive) {
    return convex_parts(primitive).size();
}

Shadow::Cover Shadow::draw_hull(std::span<const Vec3> corners, std::size_t ring, const Affine& place) {
    ++bodies_drawn_;
    points_.clear();
    const Vec3 across = glm::transpose(place.linear) * right_ * unit_;
    const Vec3 upward = glm::transpose(place.linear) * up_ * unit_;
    const Point centre = project(place.translation);
    for (const Vec3& corner : corners) {
        points_.push_back({centre.x + glm::dot(across, corner), centre.y + glm::dot(upward, corner)});
        if (!is_near(points_.back())) return {};
    }
    const std::size_t top = ring > 0 && join_rings(ring) ? start_at_lowest() : wrap_points();
    Cover cover;
    for (std::size_t i = 0; i + 1 < hull_.size(); ++i)
        cover.area += 0.5 * (hull_[i].x * hull_[i + 1].y - hull_[i + 1].x * hull_[i].y);
    cover.area = std::max(cover.area, 0.0);
    fill_hull(top, cover);
    return cover;
}

/// The hull of two rings whose edges are parallel. At a side that both have, the outer ring has it to itself;
/// where the outer one changes, the hull passes from ring to ring. False if they are seen from their edge.
bool Shadow::join_rings(std::size_t count) {
    const Point *const a = points_.data(), *const b = a + count;
    double area = 0, reach = 0;
    for (std::size_t i = 0, last = count - 1; i < count; last = i++) {
        area += (a[last].x - a[0].x) * (a[i].y - a[0].y) - (a[i].x - a[0].x) * (a[last].y - a[0].y);
        reach = std::max({reach, std::abs(a[i].x - a[0].x), std::abs(a[i].y - a[0].y)});
    }
    constexpr double narrowest = 1e-6;
    if (!(std::abs(area) > narrowest * reach * reach)) return false;
    const auto is_outer = [&](std::size_t from, std::size_t to) {
        const double dx = a[to].x - a[from].x, dy = a[to].y - a[from].y;
        return ((a[from].x - b[from].x) * dy - (a[from].y - b[from].y) * dx) * area >= 0;
    };
    hull_.clear();
    bool before = is_outer(count - 1, 0);
    for (std::size_t i = 0; i < count; ++i) {
        const bool after = is_outer(i, i + 1 == count ? 0 : i + 1);
        hull_.push_back(before ? a[i] : b[i]);
        if (before != after) hull_.push_back(after ? a[i] : b[i]);
        before = after;
    }
    if (area < 0) std::reverse(hull_.begin(), hull_.end());
    return true;
}

/// Turns the hull's corners, which go round it to the left, so that the first is its lowest, and repeats it
/// at the end. Returns the number of the highest.
std::size_t Shadow::start_at_lowest() {
    const auto lower = [](const Point& p, const Point& q) { return p.y < q.y; };
    std::rotate(hull_.begin(), std::min_element(hull_.begin(), hull_.end(), lower), hull_.end());
    const auto top = std::max_element(hull_.begin(), hull_.end(), lower) - hull_.begin();
    hull_.push_back(hull_.front());
    return static_cast<std::size_t>(top);
}

/// The hull of any points, to the left from its lowest corner and back to that. Returns the number of the
/// highest.
std::size_t Shadow::wrap_points() {
    std::sort(points_.begin(), points_.end(),
              [](const Point& a, const Point& b) { return a.y != b.y ? a.y < b.y : a.x < b.x; });
    // Andrew's monotone chains, the right one up and the left one down again.
    hull_.clear();
    const auto add = [&](const Point& p, std::size_t keep) {
        const auto turns_inward = [&](const Point& a, const Point& b) {
            return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x) <= 0;
        };
        while (hull_.size() >= keep + 2 && turns_inward(hull_[hull_.size() - 2], hull_.back()))
            hull_.pop_back();
        hull_.push_back(p);
    };
    for (const Point& p : points_)
        add(p, 0);
    const std::size_t top = hull_.size() - 1;
    for (std::size_t i = points_.size() - 1; i-- > 0;)
        add(points_[i], top);
    return top;
}

void Shadow::fill_hull(std::size_t top, Cover& cover) {
    // A side of the hull, followed upwards: x = at y.
    struct Side {
        std::size_t at;
        double x = 0, slope = 0, y = 0;
    };
    const auto turn_corner = [&](Side& side, std::size_t next) {
        const Point &a = hull_[side.at], &b = hull_[next];
        side.x = a.x;
        side.y = a.y;
        side.slope = b.y > a.y ? (b.x - a.x) / (b.y - a.y) : 0;
    };
    Side right{0}, left{hull_.size() - 1};
    turn_corner(right, 1);
    turn_corner(left, left.at - 1);
    const int end = first_row(hull_[top].y);
    for (int row = first_row(hull_.front().y); row < end; ++row) {
        const double y = row + 0.5;
        while (right.at + 1 < top && hull_[right.at + 1].y < y)
            ++right.at, turn_corner(right, right.at + 1);
        while (left.at > top + 1 && hull_[left.at - 1].y < y)
            --left.at, turn_corner(left, left.at - 1);
        cover_row(row, left.x + left.slope * (y - left.y), right.x + right.slope * (y - right.y), cover);
    }
}

} // namespace graftal
