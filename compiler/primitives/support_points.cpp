#include "compiler/primitives/support_points.h"

#include <numbers>

namespace graftal {

Vec3 circle_point(double turn) {
    constexpr double pi = std::numbers::pi;
    return {std::cos(2 * pi * turn), 0, std::sin(2 * pi * turn)};
}

} // namespace graftal
