#pragma once

#include "compiler/support/affine.h"

namespace graftal {

/// The largest absolute value of the eigenvalues: by squaring (Gelfand's formula), to about 1e-6 of it.
double spectral_radius(Mat3 matrix);

} // namespace graftal
