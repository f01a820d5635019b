#pragma once

#include <cstdint>

#include <glm/vec2.hpp>

namespace graftal {

/// The random numbers of one sample of a pixel, pair after pair. Over the samples of a pixel each pair runs
/// through the first two dimensions of Sobol's sequence, scrambled as Owen does and in an order of its own
/// (Burley, "Practical hash-based Owen scrambling", JCGT 9 (2020)), so that any number of samples spreads
/// evenly; pairs, and pixels, have nothing to do with each other. A function of seed and index alone.
class SampleStream {
  public:
    /// `seed`: of the pixel; `index`: of the sample, from 0.
    SampleStream(std::uint64_t seed, std::uint32_t index) : seed_(seed), index_(index) {}

    /// Both in [0, 1).
    glm::dvec2 next();

  private:
    std::uint64_t seed_;
    std::uint32_t index_;
    std::uint64_t pair_ = 0;
};

} // namespace graftal
