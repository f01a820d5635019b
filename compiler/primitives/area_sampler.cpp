#include "compiler/primitives/area_sampler.h"

#include <algorithm>

namespace graftal {

std::size_t AreaSampler::piece(double share) const {
    const auto found = std::upper_bound(sums_.begin(), sums_.end() - 1, share * whole());
    return static_cast<std::size_t>(found - sums_.begin());
}

} // namespace graftal
