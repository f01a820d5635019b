#include "compiler/support/normal_map.h"

#include <glm/geometric.hpp>

namespace graftal {

Mat3 normal_map(const Mat3& linear) {
    const double size = largest_entry(linear);
    const Vec3 x = linear[0] / size, y = linear[1] / size, z = linear[2] / size;
    const Mat3 cofactors(glm::cross(y, z), glm::cross(z, x), glm::cross(x, y));
    const double largest = largest_entry(cofactors);
    const double mirror = glm::dot(x, cofactors[0]) < 0 ? -1 : 1;
    return cofactors * (mirror / largest);
}

} // namespace graftal
