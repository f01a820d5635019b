#pragma once

#include "compiler/support/affine.h"

namespace graftal {

/// POV-Ray cannot place what a matrix flattens. It ends on singular matrices, and silently takes 1 for the
/// diagonal of an axis shorter than 1e-10. It sees no solid thinner than about 2e-4 (measured: squashed
/// spheres, cylinders, cones, tori and closed meshes vanish, boxes do not). This gives the map with its
/// singular values raised to 5e-4, or to 1/100 of the largest where that is less: a thickness that no picture
/// shows at the scale of a scene (view.h). Maps that need no help come back unchanged.
Affine regular(const Affine& a);

} // namespace graftal
