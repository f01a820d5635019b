#pragma once

#include "compiler/import/importer.h"

namespace graftal {

/// Fractal flames (`.flame`, `.flam3`) of flam3, Apophysis and their kin (Draves and Reckase, "The Fractal
/// Flame Algorithm"). Flames whose maps are affine and shrink become `.rifs`, with `chaos` (xaos) as the
/// control digraph. Others become orbits, as far as their variations have formulas.
Importer flame_importer();

} // namespace graftal
