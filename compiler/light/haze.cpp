#include "compiler/light/haze.h"

#include <cmath>

namespace graftal {

namespace {

/// The integral of the density from the base to s heights above it.
double column(double s) {
    return s > 0 ? std::atan(s) : s;
}

} // namespace

double Haze::left_after(Vec3 from, Vec3 direction, double length) const {
    const double begin = (from.y - base) / height; // 0 where it is even
    const double end = begin + length * direction.y / height;
    double density = 1;
    if (begin > 0 || end > 0) {
        constexpr double level = 1e-4; // POV-Ray's: below, the quotient is lost in rounding
        if (std::abs(end - begin) > level)
            density = (column(end) - column(begin)) / (end - begin);
        else if (begin > 0)
            density = 1 / (1 + begin * begin);
    }
    return std::exp(-length * density / distance);
}

} // namespace graftal
