#include "compiler/light/haze.h"

#include <algorithm>

#include <glm/geometric.hpp>

#include "compiler/light/formulas.h"

namespace graftal {

double Haze::left_after(Vec3 from, Vec3 direction, double length) const {
    const double begin = (from.y - base) / height; // 0 where it is even
    return formulas::left_after_haze(begin, begin + length * direction.y / height, length, distance);
}

double Haze::length_of_share(Vec3 from, Vec3 direction, double length, double share) const {
    const double wanted = share * (1 - left_after(from, direction, length));
    if (is_even()) return std::min(length, -distance * std::log1p(-wanted));
    double near = 0, far = length;
    constexpr int halvings = 50;
    for (int i = 0; i < halvings; ++i) {
        const double middle = 0.5 * (near + far);
        (1 - left_after(from, direction, middle) < wanted ? near : far) = middle;
    }
    return far;
}

double Haze::scattered(Vec3 direction, Vec3 to_sun) {
    return formulas::forward_scattering(glm::dot(direction, to_sun) / glm::length(to_sun));
}

} // namespace graftal
