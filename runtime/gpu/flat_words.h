#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include <glm/vec4.hpp>

#include "compiler/support/affine.h"

namespace graftal {

/// A word among the kernel's floats.
inline float flat_bits(std::uint32_t word) {
    return std::bit_cast<float>(word);
}

/// A positive length, or what stands for it where single precision has none: rays see either as nothing or as
/// all.
inline double flat_length(double length) {
    return std::clamp(length, 1e-30, 1e30);
}

inline glm::vec4 flat_four(Vec3 v, double w = 0) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), static_cast<float>(w)};
}

} // namespace graftal
