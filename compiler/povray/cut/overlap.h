#pragma once

#include "compiler/povray/cut_parts.h"
#include "compiler/scene/scene.h"

namespace graftal {

/// The mean number of placements whose boxes cover a pixel of the picture. A ray of POV-Ray looks into no
/// more, for it ends at its first hit. A placement counts as if its box were seen from all sides at its
/// nearest point, and as the whole picture at most. One out of the picture does not count.
double mean_overlap(const Cut& cut, const View& view);

} // namespace graftal
