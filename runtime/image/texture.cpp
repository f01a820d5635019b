#include "runtime/image/texture.h"

#include <algorithm>
#include <cmath>

#include "compiler/support/srgb.h"

namespace graftal {

namespace {

/// The number of the texel that holds x, of n from 0 to 1, repeated.
std::size_t texel_number(double x, int n) {
    const double within = x - std::floor(x);
    if (!(within >= 0)) return 0; // not a number
    return std::min(static_cast<std::size_t>(within * n), static_cast<std::size_t>(n - 1));
}

} // namespace

const Texture::Texel& Texture::at(double u, double v) const {
    const std::size_t row = static_cast<std::size_t>(height) - 1 - texel_number(v, height);
    return texels[row * static_cast<std::size_t>(width) + texel_number(u, width)];
}

double srgb_decoded(std::uint8_t level) {
    return linear_from_srgb(level / 255.0);
}

} // namespace graftal
