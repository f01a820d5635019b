#include "compiler/light/haze.h"

#include <algorithm>

#include <glm/geometric.hpp>

#include "compiler/light/formulas.h"

namespace graftal {

namespace {

/// An even haze has an infinite height: a way in it begins at 0 and does not rise.
formulas::HazeWay way_in(const Haze& haze, Vec3 from, Vec3 direction) {
    return {(from.y - haze.base) / haze.height, direction.y, haze.height, haze.distance};
}

} // namespace

double Haze::left_after(Vec3 from, Vec3 direction, double length) const {
    return formulas::left_after_haze(way_in(*this, from, direction), length);
}

double Haze::length_of_share(Vec3 from, Vec3 direction, double length, double share) const {
    if (!is_even()) return formulas::length_of_haze_share(way_in(*this, from, direction), length, share);
    const double wanted = share * (1 - left_after(from, direction, length));
    return std::min(length, -distance * std::log1p(-wanted));
}

double Haze::scattered(Vec3 direction, Vec3 to_sun) {
    return formulas::forward_scattering(glm::dot(direction, to_sun) / glm::length(to_sun));
}

} // namespace graftal
