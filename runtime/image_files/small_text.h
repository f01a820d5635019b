#pragma once

#include <string_view>

#include "runtime/image/image.h"

namespace graftal {

/// The size of a letter, with the space around it.
inline constexpr int letter_width_px = 6, letter_height_px = 10;

/// Writes a line of text over a picture, in the X11 font 6x10 (in the public domain), which needs no file.
/// Its top left is at x, y; what lies outside is left out. Bytes that are not printable ASCII become '?'. Ink
/// sets all channels to `level`.
void write_small_text(std::string_view text, int x, int y, float level, Image& picture);

} // namespace graftal
