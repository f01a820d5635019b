#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "compiler/support/tint.h"

namespace graftal {

/// A picture that is wrapped round parts of a model, as both engines look it up: the texel that holds a
/// point, none mixed with its neighbours, and nothing where it is clear. POV-Ray reads it from a PNG of just
/// these numbers.
struct Texture {
    struct Texel {
        std::array<std::uint8_t, 3> srgb{};
        bool clear = false; ///< alpha below 1/2
    };

    int file_width = 0, file_height = 0;
    int width = 0, height = 0; ///< of the file, or less by a whole number and rounded up
    std::vector<Texel> texels; ///< row by row, top first
    Rgb mean{0.0};             ///< linear, of the texels that are not clear
    double coverage = 0;       ///< their share

    /// The texel at u to the right and v upwards, repeated beyond [0, 1).
    const Texel& at(double u, double v) const;
};

/// Linear light of an sRGB level.
double srgb_decoded(std::uint8_t level);

} // namespace graftal
