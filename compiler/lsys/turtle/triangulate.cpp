#include "compiler/lsys/turtle/triangulate.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "compiler/lsys/turtle/thin_ring.h"

namespace graftal {

namespace {

using Vec2 = glm::dvec2;

/// Twice the signed area.
double turn(Vec2 a, Vec2 b, Vec2 c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

class EarClipper {
  public:
    EarClipper(std::span<const Vec3> corners, Vec3 normal) : left_(corners.size()) {
        const Vec3 n = glm::normalize(normal);
        const Vec3 aside = std::abs(n.x) < 0.6 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
        const Vec3 u = glm::normalize(glm::cross(aside, n)), v = glm::cross(n, u);
        for (const Vec3& corner : corners)
            flat_.emplace_back(glm::dot(corner - corners[0], u), glm::dot(corner - corners[0], v));
        std::iota(left_.begin(), left_.end(), 0u);
        double size = 0;
        for (const Vec2& corner : flat_)
            size = std::max({size, std::abs(corner.x), std::abs(corner.y)});
        least_length_ = 1e-9 * size;
        least_area_ = 1e-9 * size * size;
        drop_straight_corners();
        ears_.resize(left_.size());
        update_all();
    }

    std::vector<std::array<std::uint32_t, 3>> run() && {
        std::size_t at = 0, since_ear = 0;
        while (left_.size() > 3) {
            if (since_ear > left_.size() && update_all()) since_ear = 0;
            // Where nothing is an ear, the polygon crosses itself: then the next corner has to do.
            if (ears_[at] || since_ear > left_.size()) {
                clip(at);
                // No other corner becomes an ear by that (O'Rourke, Computational Geometry in C, section
                // 1.4), unless the polygon touches itself.
                update((at + left_.size() - 1) % left_.size());
                update(at % left_.size());
                updated_ = false;
                since_ear = 0;
            } else {
                ++since_ear;
            }
            at = (at + 1) % left_.size();
        }
        if (left_.size() == 3) clip(0);
        return std::move(triangles_);
    }

  private:
    /// Corners that lie between their neighbours, and spikes: what they decide would be decided by rounding.
    void drop_straight_corners() {
        thin_ring(left_, [&](std::size_t at) { return std::abs(turn_at(at)) <= least_area_; });
    }

    double turn_at(std::size_t at) const {
        return turn(flat_[corner(at + left_.size() - 1)], flat_[corner(at)], flat_[corner(at + 1)]);
    }

    std::uint32_t corner(std::size_t at) const { return left_[at % left_.size()]; }

    void update(std::size_t at) { ears_[at] = is_ear(at); }

    /// False if that changes nothing, or would take too long.
    bool update_all() {
        const std::size_t work = left_.size() * left_.size();
        if (updated_ || work > work_left_) return false;
        work_left_ -= work;
        for (std::size_t at = 0; at < left_.size(); ++at)
            update(at);
        return updated_ = true;
    }

    bool is_ear(std::size_t at) const {
        const std::uint32_t a = corner(at + left_.size() - 1), b = corner(at), c = corner(at + 1);
        if (turn_at(at) <= least_area_) return false;
        for (const std::uint32_t other : left_)
            if (other != a && other != b && other != c && holds(a, b, c, flat_[other])) return false;
        return true;
    }

    bool holds(std::uint32_t a, std::uint32_t b, std::uint32_t c, Vec2 point) const {
        if (turn(flat_[a], flat_[b], point) < -least_area_ ||
            turn(flat_[b], flat_[c], point) < -least_area_ || turn(flat_[c], flat_[a], point) < -least_area_)
            return false;
        // A corner met twice, as where a hole is joined, does not close the ear.
        for (const std::uint32_t own : {a, b, c})
            if (glm::distance(point, flat_[own]) <= least_length_) return false;
        return true;
    }

    void clip(std::size_t at) {
        const std::array triangle = {corner(at + left_.size() - 1), corner(at), corner(at + 1)};
        if (std::abs(turn_at(at)) > least_area_) triangles_.push_back(triangle);
        left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(at));
        ears_.erase(ears_.begin() + static_cast<std::ptrdiff_t>(at));
    }

    double least_length_ = 0;
    double least_area_ = 0; ///< twice it
    std::vector<Vec2> flat_;
    std::vector<std::uint32_t> left_;
    std::vector<char> ears_; ///< of left_
    bool updated_ = false;   ///< since the last corner was clipped
    std::size_t work_left_ = 200'000'000;
    std::vector<std::array<std::uint32_t, 3>> triangles_;
};

} // namespace

Vec3 newell_normal(std::span<const Vec3> corners) {
    Vec3 normal(0.0);
    for (std::size_t i = 0; i < corners.size(); ++i)
        normal += glm::cross(corners[i] - corners[0], corners[(i + 1) % corners.size()] - corners[0]);
    return normal;
}

std::vector<std::array<std::uint32_t, 3>> triangulate(std::span<const Vec3> corners) {
    if (corners.size() < 3) return {};
    double size = 0;
    for (const Vec3& corner : corners)
        size = std::max(size, largest_entry(corner - corners[0]));
    // Areas are squared: at the ends of the range of numbers a double would not hold that.
    constexpr double largest = 1e50;
    if (size > largest || (size > 0 && size < 1 / largest)) {
        if (!std::isfinite(size)) return {};
        std::vector<Vec3> of_size_1;
        for (const Vec3& corner : corners)
            of_size_1.push_back((corner - corners[0]) / size);
        return triangulate(of_size_1);
    }
    const Vec3 normal = newell_normal(corners);
    if (!(glm::length(normal) > 0) || !std::isfinite(glm::length(normal))) return {};
    return EarClipper(corners, normal).run();
}

} // namespace graftal
