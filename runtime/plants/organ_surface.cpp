#include "runtime/plants/organ_surface.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <glm/geometric.hpp>

#include "runtime/trace/shade/formulas.h"

namespace graftal {

namespace {

constexpr double pi = std::numbers::pi;
constexpr double thickness_of_taper = 1.0 / 128, half_thickness_of_disc = 0.5e-3;

} // namespace

OrganSurface::OrganSurface(const Plant& plant, std::uint32_t module, const PlantBlade* blade)
    : module_(plant.modules[module]) {
    const double width = std::max(module_.width, module_.base_width);
    switch (module_.organ) {
    case Organ::segment:
        area_ = module_.start != module_.end ? module_.area : 0;
        thickness_ = thickness_of_taper * width;
        break;
    case Organ::ball:
        area_ = module_.area;
        thickness_ = 1e-6 * width;
        break;
    case Organ::disc:
        area_ = module_.area;
        thickness_ = half_thickness_of_disc * width;
        flat_ = true;
        break;
    case Organ::polygon:
    case Organ::model:
        flat_ = true;
        if (!blade) break;
        thickness_ = blade->half_thickness;
        for (const PlantTriangle& triangle : plant.shapes[blade->shape]) {
            const Vec3 a = blade->world_from_shape(triangle[0]), b = blade->world_from_shape(triangle[1]),
                       c = blade->world_from_shape(triangle[2]);
            const double area = glm::length(glm::cross(b - a, c - a)) / 2;
            if (!(area > 0)) continue;
            area_ += area;
            triangles_.push_back({a, b, c});
            area_up_to_.push_back(area_);
        }
        break;
    case Organ::none:
        break;
    }
}

OrganSurface::Place OrganSurface::at(glm::dvec2 uv) const {
    switch (module_.organ) {
    case Organ::segment:
        return on_segment(uv);
    case Organ::ball:
        return on_ball(uv);
    case Organ::disc:
        return on_disc(uv);
    case Organ::polygon:
    case Organ::model:
        return on_blade(uv);
    case Organ::none:
        break;
    }
    return {};
}

/// A place along a frustum is as likely as the circle there is long.
OrganSurface::Place OrganSurface::on_segment(glm::dvec2 uv) const {
    const double from = module_.base_width / 2, to = module_.width / 2;
    double along = uv.x;
    if (std::abs(to - from) > 1e-9 * std::max(from, to))
        along = (std::sqrt(from * from + uv.x * (to * to - from * from)) - from) / (to - from);
    const Vec3 way = module_.end - module_.start;
    const double length = glm::length(way);
    const Vec3 axis = way / length;
    Vec3 a, b;
    formulas::axes_across_of(axis, a, b);
    const double turn = 2 * pi * uv.y;
    const Vec3 across = std::cos(turn) * a + std::sin(turn) * b;
    const double radius = from + along * (to - from);
    return {module_.start + along * way + radius * across,
            glm::normalize(length * across + (from - to) * axis)};
}

OrganSurface::Place OrganSurface::on_ball(glm::dvec2 uv) const {
    const Vec3 normal = formulas::from_pole({0, 1, 0}, 1 - 2 * uv.x, 2 * pi * uv.y);
    return {module_.start + module_.width / 2 * normal, normal};
}

OrganSurface::Place OrganSurface::on_disc(glm::dvec2 uv) const {
    const double radius = module_.width / 2 * std::sqrt(uv.x), turn = 2 * pi * uv.y;
    return {module_.start + radius * (std::cos(turn) * module_.heading + std::sin(turn) * module_.left),
            module_.up};
}

/// The first number chooses the triangle, and what is left of it the place there (Turk 1990, "Generating
/// random points in triangles").
OrganSurface::Place OrganSurface::on_blade(glm::dvec2 uv) const {
    const double chosen = uv.x * area_;
    const auto found = std::ranges::upper_bound(area_up_to_, chosen);
    const auto number =
        std::min(static_cast<std::size_t>(found - area_up_to_.begin()), triangles_.size() - 1);
    const double before = number > 0 ? area_up_to_[number - 1] : 0;
    const double u = std::clamp((chosen - before) / (area_up_to_[number] - before), 0.0, 1.0);
    const auto& [a, b, c] = triangles_[number];
    const double root = std::sqrt(u);
    return {a + root * (1 - uv.y) * (b - a) + root * uv.y * (c - a),
            glm::normalize(glm::cross(b - a, c - a))};
}

} // namespace graftal
