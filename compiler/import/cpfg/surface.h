#pragma once

#include "compiler/import/importer.h"

namespace graftal {

/// Surfaces of the Virtual Laboratory (`.s`, by stedit and bezieredit): Bezier patches of four rows of four
/// points, with the point, the heading and the up vector by which cpfg's turtle takes hold of them.
Importer vlab_surface_importer();

} // namespace graftal
