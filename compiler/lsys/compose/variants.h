#pragma once

#include <cstdint>
#include <vector>

#include "compiler/lsys/derive/rewriter.h"

namespace graftal {

/// Chance inside the instancing paradigm: of every part that is random there are `count` variants, numbered.
/// The alternatives of a production are dealt out to them in proportion to their probabilities (stratified).
/// For each place of a string a permutation says which variant of the child goes into which variant of the
/// parent: each child is used equally often. Expectations stay those of honest derivations; the mean over
/// the pool strays less than that of as many independent samples.
class Variants {
  public:
    /// `count` must be a power of two.
    Variants(std::uint64_t seed, std::uint32_t count) : seed_(seed), mask_(count - 1) {}

    std::uint32_t count() const { return mask_ + 1; }

    /// The variant of a child at a place of the parent's string.
    std::uint32_t child(std::uint32_t variant, ModuleId parent, std::uint32_t stage, std::size_t place) const;
    /// The alternative that a variant takes. Requires that they share all draws.
    Winner<Alternative> choose(const std::vector<Alternative>& alternatives, std::uint32_t variant,
                               ModuleId module, std::uint32_t stage) const;

  private:
    std::uint64_t seed_;
    std::uint32_t mask_;
};

} // namespace graftal
