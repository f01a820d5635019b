#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <tsl/robin_set.h>

#include "compiler/support/affine.h"

namespace graftal {

/// Recognises what was placed before: the same thing under the same map, to 1e-9 of `size`. POV-Ray draws
/// tens of thousands of coincident objects black, or crashes. Keeps 128-bit digests, not the maps.
class PlacedSet {
  public:
    /// Room is made for as many as are expected.
    explicit PlacedSet(double size, std::size_t expected = 0);

    /// False if it is there already.
    bool insert(std::uint32_t thing, const Affine& place);

  private:
    using Digest = std::array<std::uint64_t, 2>;
    struct First {
        std::size_t operator()(const Digest& digest) const { return digest[0]; }
    };

    double unit_;
    tsl::robin_set<Digest, First> seen_;
};

} // namespace graftal
