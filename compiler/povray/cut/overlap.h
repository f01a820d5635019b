#pragma once

#include "compiler/povray/cut_parts.h"
#include "compiler/scene/scene.h"

namespace graftal {

/// Boxes of placements over a pixel of the picture, on average. POV-Ray's rays look into no more, for a ray
/// ends where it hits. A placement counts as if its box were seen from all sides at its nearest point, and
/// as the whole picture at most. One out of the picture does not count.
double mean_overlap(const Cut& cut, const View& view);

} // namespace graftal
