#pragma once

#include "compiler/support/tint.h"

namespace graftal {

/// Facts of a picture that a material names, for a compiler.
struct TextureFacts {
    Rgb mean{0.0};       ///< of its linear colours, where it is not clear
    double coverage = 1; ///< the share of it that is not clear
    int file_width = 0, file_height = 0;
    int width = 0, height = 0; ///< as it is used: smaller, where the file holds more than there is room for
};

} // namespace graftal
