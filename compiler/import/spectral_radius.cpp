#include "compiler/import/spectral_radius.h"

#include <cmath>

namespace graftal {

double spectral_radius(Mat3 matrix) {
    double logarithm = 0, power = 1;
    for (int i = 0; i < 24; ++i) {
        const double size = largest_entry(matrix);
        if (!(size > 0)) return 0;
        if (!std::isfinite(size)) return size;
        logarithm += std::log(size) / power;
        matrix = (matrix / size) * (matrix / size);
        power *= 2;
    }
    return std::exp(logarithm);
}

} // namespace graftal
