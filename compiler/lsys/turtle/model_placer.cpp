#include "compiler/lsys/turtle/model_placer.h"

#include <cmath>

namespace graftal {

Vec3 placed_scale(std::span<const double> parameters) {
    if (parameters.empty()) return Vec3(1.0);
    if (parameters.size() == 1) return Vec3(parameters[0]);
    if (parameters.size() > 2) return {parameters[0], parameters[1], parameters[2]};
    return {parameters[0], parameters[1], std::sqrt(std::abs(parameters[0] * parameters[1]))};
}

} // namespace graftal
