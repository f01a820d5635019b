#pragma once

#include "runtime/image/image.h"

namespace graftal {

/// Spreads a share of the light, in [0, 1], around each pixel, as a lens does: over distances from four
/// pixels to an eighth of the picture, each twice the one before, and each with the same light. Requires
/// three channels of linear light. O(pixels).
void spread_glow(Image& light, double share);

} // namespace graftal
