#pragma once

#include "compiler/povray/cut_parts.h"
#include "compiler/scene/scene.h"

namespace graftal {

/// How many boxes of placements lie over a pixel of the picture, on average: what POV-Ray's rays have to look
/// into at most, for a ray ends where it hits. A placement counts as if its box were seen from all sides at
/// its nearest point, and as the whole picture at most; one out of the picture does not count.
double mean_overlap(const Cut& cut, const View& view);

} // namespace graftal
