#pragma once

#include "compiler/scene/scene.h"
#include "compiler/support/bounds.h"

namespace graftal {

/// Whether all of the box is behind the camera, or beyond one edge of its picture by some pixels. A box of
/// which the picture shows nothing need not be missed in this sense.
bool misses(const Camera& camera, const Box& box, ImageSize size);

} // namespace graftal
