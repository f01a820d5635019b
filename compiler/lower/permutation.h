#pragma once

#include <bit>
#include <cstdint>

#include "compiler/support/counter_random.h"

namespace graftal {

// Pools of variants: chance inside the instancing paradigm. The graph contains a random object as a number of
// variants, a power of two. They get values and alternatives by stratified sampling. If one random object
// contains another, a permutation chooses the variant of the child for each variant of the parent. So a graph
// uses all variants equally often.

/// The number's place in an order of the numbers from 0 to `mask`; the key chooses the order. Requires that
/// `mask` + 1 is a power of two. Odd factors, additions and shifts are bijections of the numbers below a
/// power of two.
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

/// A number of [0, 1) for a variant. Each variant gets another of `mask` + 1 equal parts, in an order that
/// the key chooses.
inline double stratified(std::uint32_t variant, std::uint32_t mask, std::uint64_t key) {
    const double inside = CounterRandom::unit(CounterRandom::scrambled(key ^ variant));
    return (permuted(variant, mask, key) + inside) / (double{1} + mask);
}

} // namespace graftal
