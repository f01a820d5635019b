#pragma once

#include <bit>
#include <cstdint>

#include "compiler/support/counter_random.h"

namespace graftal {

// Pools of variants: chance inside the instancing paradigm. Whatever is random stands in the graph as `count`
// variants, a power of two. Values and alternatives are dealt out to them stratified, and where one random
// thing holds another, a permutation says which variant of the child each variant of the parent holds, so
// that all are used equally often.

/// The number's place in an order of the numbers from 0 to `mask` that the key chooses. Requires that `mask`
/// is a power of two less one. Odd factors, additions and shifts are bijections of the numbers below a power
/// of two.
inline std::uint32_t permuted(std::uint32_t number, std::uint32_t mask, std::uint64_t key) {
    const int half = (std::bit_width(mask) + 1) / 2;
    for (int round = 0; round < 3; ++round) {
        key = CounterRandom::scrambled(key);
        number =
            (number * (static_cast<std::uint32_t>(key) | 1u) + static_cast<std::uint32_t>(key >> 32)) & mask;
        number ^= number >> half;
    }
    return number;
}

/// A number of [0, 1) for a variant: one of each of `mask` + 1 equal parts, in an order that the key chooses.
inline double stratified(std::uint32_t variant, std::uint32_t mask, std::uint64_t key) {
    const double inside = CounterRandom::unit(CounterRandom::scrambled(key ^ variant));
    return (permuted(variant, mask, key) + inside) / (double{1} + mask);
}

} // namespace graftal
