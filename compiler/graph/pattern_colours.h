#pragma once

#include <glm/common.hpp>

#include "compiler/graph/material.h"

namespace graftal {

/// Gives the pattern of a material the colours that it has where it names none: darker and lighter than the
/// material's own. A new colour of the material takes new ones along.
inline void take_own_colours(Material& material) {
    constexpr double contrast = 0.35;
    material.pattern.low = (1 - contrast) * material.rgb;
    material.pattern.high = glm::min((1 + contrast) * material.rgb, Rgb(1.0));
}

} // namespace graftal
