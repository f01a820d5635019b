#pragma once

#include "compiler/support/affine.h"

namespace graftal {

/// Turns the columns of `a` until they are at right angles, by one-sided Jacobi rotations (Golub and Van
/// Loan, Matrix Computations, 8.6.3): after that their lengths are the singular values, in no order, to about
/// 1e-15 of the largest. The rotations are applied to the columns of `turn` too, where there is one: if that
/// was the identity, the matrix that came in is the one that goes out times transpose(turn). Requires finite
/// entries whose squares neither overflow nor vanish.
///
/// It stands beside Eigen's JacobiSVD because its last bits are in every scene: analysis bounds and places by
/// them.
void make_columns_orthogonal(Mat3& a, Mat3* turn = nullptr);

} // namespace graftal
