#include "compiler/primitives/sheet.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "compiler/primitives/solid.h"

namespace graftal {

std::optional<Sheet> sheet_of(const Primitive& primitive, const Mat3& linear, const SheetLimits& limits) {
    if (!traits_of(primitive).bounded) return std::nullopt;
    const double largest = largest_entry(linear);
    if (!(largest > 0 && std::isfinite(largest))) return std::nullopt;
    const Mat3 map = linear / largest; // squares of its lengths are numbers
    // Cofactors of a flat map are the product of its two larger stretches, along the third's direction.
    Vec3 across(0.0);
    double longest = 0;
    for (int i = 0; i < 3; ++i) {
        const Vec3 cofactors = glm::cross(map[i], map[(i + 1) % 3]);
        if (glm::length(cofactors) > glm::length(across)) across = cofactors;
        longest = std::max(longest, glm::length(map[i]));
    }
    const double area = glm::length(across);
    if (!(area > 0)) return std::nullopt;
    const Vec3 normal = across / area;
    const Vec3 along = normal * map; // the transposed map of the normal
    const double shorter = area / longest;
    const double thickness = primitive_support(primitive, along) + primitive_support(primitive, -along);
    if (!(thickness <= limits.of_mean * std::sqrt(area) && thickness <= limits.of_shorter * shorter))
        return std::nullopt;
    if (!encloses_volume(primitive)) return std::nullopt;
    return Sheet{normal, largest * thickness};
}

} // namespace graftal
