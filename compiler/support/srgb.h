#pragma once

#include <cmath>
#include <optional>
#include <string_view>

#include "compiler/support/tint.h"

namespace graftal {

/// A component in [0, 1] as pictures and the web store it, in linear light (IEC 61966-2-1).
inline double linear_from_srgb(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

inline Rgb linear_from_srgb(Rgb encoded) {
    return {linear_from_srgb(encoded.r), linear_from_srgb(encoded.g), linear_from_srgb(encoded.b)};
}

/// `rgb` or `rrggbb` in hexadecimal digits, encoded, components in [0, 1]. Nothing for other texts.
std::optional<Rgb> srgb_from_hex(std::string_view digits);

} // namespace graftal
