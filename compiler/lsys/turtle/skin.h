#pragma once

#include <optional>
#include <vector>

#include "compiler/lsys/turtle/limb.h"
#include "compiler/support/affine.h"

namespace graftal {

/// A limb as the numbers of a `limb_sweep`, and its place.
struct LimbSkin {
    std::vector<double> numbers;
    Affine start_from_skin; ///< a rotation, a uniform scale and a shift
};

/// The skin of this many sides. Limbs that differ by a rotation, a uniform scale and rounding have equal
/// numbers: about one unit long, from the origin, up the y axis at first, and then towards x. Nothing for a
/// limb without length or thickness. Requires finite nodes.
std::optional<LimbSkin> skin_of(const Limb& limb, int sides);

} // namespace graftal
