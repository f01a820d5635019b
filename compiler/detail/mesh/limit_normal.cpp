#include "compiler/detail/mesh/limit_normal.h"

#include <cmath>

namespace graftal {

void NormalField::add(int level, Vec3 centre, double radius) {
    if (!(radius > 0)) return;
    const double slope = std::pow(limit_normal_ratio, -level) / radius;
    spread += slope;
    offset += slope * centre;
}

NormalField NormalField::seen_from(double scale, Vec3 shift) const {
    return {spread * scale, offset - spread * shift};
}

} // namespace graftal
