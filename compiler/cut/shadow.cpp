#include "compiler/cut/shadow.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <mutex>
#include <numbers>

#include <glm/geometric.hpp>

#include "compiler/cut/tessellate.h"
#include "compiler/support/check.h"

namespace graftal {

namespace {

using std::numbers::pi;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr int torus_parts = 12;
constexpr int prism_sides = 8;

/// A prism or pyramid in place of what is round about the y axis, as long around: the shadows of slender
/// ones, which are what there are most of, are as wide.
std::vector<Vec3> round_corners(double top) {
    const double radius = pi / (prism_sides * std::sin(pi / prism_sides));
    std::vector<Vec3> corners;
    for (int i = 0; i < prism_sides; ++i) {
        const double angle = 2 * pi * i / prism_sides;
        const Vec3 spoke(radius * std::cos(angle), 0, radius * std::sin(angle));
        corners.push_back(spoke);
        if (top > 0) corners.push_back(top * spoke + Vec3(0, 1, 0));
    }
    if (!(top > 0)) corners.emplace_back(0, 1, 0);
    return corners;
}

/// Convex bodies, given by their corners, whose union is the primitive.
std::vector<std::vector<Vec3>> make_convex_parts(PrimitiveKind kind) {
    if (kind == PrimitiveKind::cube || kind == PrimitiveKind::triangle)
        return {tessellated(kind, 0).vertices};
    if (kind != PrimitiveKind::torus) return {round_corners(top_radius(kind))};
    const std::vector<Vec3>& ring = tessellated(kind, 1).vertices;
    const std::size_t around = ring.size() / torus_parts;
    std::vector<std::vector<Vec3>> parts(torus_parts);
    for (std::size_t part = 0; part < torus_parts; ++part)
        for (std::size_t i = 0; i < 2 * around; ++i)
            parts[part].push_back(ring[(part * around + i) % ring.size()]);
    return parts;
}

const std::vector<std::vector<Vec3>>& convex_parts(PrimitiveKind kind) {
    static std::array<std::once_flag, primitive_kind_count> made;
    static std::array<std::vector<std::vector<Vec3>>, primitive_kind_count> parts;
    const auto index = static_cast<std::size_t>(kind);
    std::call_once(made[index], [&] { parts[index] = make_convex_parts(kind); });
    return parts[index];
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

/// False for what is nowhere near the grid, or has no place: all would be a single point but for this.
bool Shadow::is_near(const Point& point) {
    constexpr double far = 1e15;
    return std::abs(point.x) < far && std::abs(point.y) < far;
}

int Shadow::first_row(double y) const {
    return static_cast<int>(std::ceil(std::clamp(y - 0.5, 0.0, static_cast<double>(size_))));
}

/// Covers the samples of a row in [from, to).
void Shadow::cover_row(int row, double from, double to, Cover& cover) {
    const double offset = offset_[static_cast<std::size_t>(row)];
    const auto sample = [&](double x) {
        return static_cast<int>(std::ceil(std::clamp(x - offset, 0.0, static_cast<double>(size_))));
    };
    if (!(from < to)) return;
    const int begin = sample(from), end = sample(to);
    if (begin >= end) return;
    std::uint64_t* const words = covered_.data() + static_cast<std::ptrdiff_t>(row) * (size_ / 64);
    for (int word = begin / 64; word <= (end - 1) / 64; ++word) {
        const int low = std::max(begin - 64 * word, 0), high = std::min(end - 64 * word, 64);
        const std::uint64_t mask = (high == 64 ? ~0ull : (1ull << high) - 1) & ~((1ull << low) - 1);
        cover.samples += std::popcount(mask);
        cover.uncovered += std::popcount(mask & ~words[word]);
        words[word] |= mask;
    }
}

Shadow::Cover Shadow::draw_sphere(const Affine& place) {
    // The shadow is the ellipse centre + B x, |x| <= 1, of which S = B B^T.
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

Shadow::Cover Shadow::draw(PrimitiveKind kind, const Affine& place) {
    if (kind == PrimitiveKind::sphere) return draw_sphere(place);
    Cover sum;
    for (const std::vector<Vec3>& part : convex_parts(kind)) {
        const Cover cover = draw_hull(part, place);
        sum.area += cover.area;
        sum.samples += cover.samples;
        sum.uncovered += cover.uncovered;
    }
    return sum;
}

Shadow::Cover Shadow::draw_hull(std::span<const Vec3> corners, const Affine& place) {
    points_.clear();
    for (const Vec3& corner : corners) {
        points_.push_back(project(place(corner)));
        if (!is_near(points_.back())) return {};
    }
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
    Cover cover;
    for (std::size_t i = 0; i + 1 < hull_.size(); ++i)
        cover.area += 0.5 * (hull_[i].x * hull_[i + 1].y - hull_[i + 1].x * hull_[i].y);
    cover.area = std::max(cover.area, 0.0);
    fill_hull(top, cover);
    return cover;
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
    const int end = first_row(points_.back().y);
    for (int row = first_row(points_.front().y); row < end; ++row) {
        const double y = row + 0.5;
        while (right.at + 1 < top && hull_[right.at + 1].y < y)
            ++right.at, turn_corner(right, right.at + 1);
        while (left.at > top + 1 && hull_[left.at - 1].y < y)
            --left.at, turn_corner(left, left.at - 1);
        cover_row(row, left.x + left.slope * (y - left.y), right.x + right.slope * (y - right.y), cover);
    }
}

} // namespace graftal
