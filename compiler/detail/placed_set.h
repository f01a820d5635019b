#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "compiler/support/affine.h"
#include "compiler/support/id_table.h"

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
    /// Two hashes, with other multipliers.
    using Digest = std::array<std::uint64_t, 2>;

    void extend(Digest& digest, double value) const;

    double unit_;
    // The last question: neighbours often differ by their translations alone.
    std::uint32_t last_thing_ = UINT32_MAX;
    Mat3 last_linear_{0.0};
    Digest last_digest_{}; ///< of both
    std::vector<Digest> digests_;
    IdTable ids_;
};

} // namespace graftal
