#include "runtime/trace/shade/sample_stream.h"

#include "compiler/support/counter_random.h"

namespace graftal {

namespace {

std::uint32_t reversed(std::uint32_t x) {
    x = (x >> 16) | (x << 16);
    x = ((x & 0x00ff00ff) << 8) | ((x & 0xff00ff00) >> 8);
    x = ((x & 0x0f0f0f0f) << 4) | ((x & 0xf0f0f0f0) >> 4);
    x = ((x & 0x33333333) << 2) | ((x & 0xcccccccc) >> 2);
    return ((x & 0x55555555) << 1) | ((x & 0xaaaaaaaa) >> 1);
}

/// Flips each bit by a hash of those below it: Laine and Karras (2011) with the constants of Vegdahl (2021).
std::uint32_t flipped_by_lower_bits(std::uint32_t x, std::uint32_t seed) {
    x ^= x * 0x3d20adea;
    x += seed;
    x *= (seed >> 16) | 1;
    x ^= x * 0x05526c56;
    x ^= x * 0x53a22864;
    return x;
}

/// Owen's scrambling: flips each bit by a hash of those above it.
std::uint32_t scrambled(std::uint32_t x, std::uint32_t seed) {
    return reversed(flipped_by_lower_bits(reversed(x), seed));
}

/// The second dimension of Sobol's sequence; the first is reversed(index).
std::uint32_t sobol_second(std::uint32_t index) {
    std::uint32_t result = 0;
    for (std::uint32_t direction = 1u << 31; index != 0; index >>= 1) {
        if (index & 1) result ^= direction;
        direction ^= direction >> 1; // the next row of Pascal's triangle mod 2
    }
    return result;
}

double unit(std::uint32_t x) {
    return x * 0x1p-32;
}

} // namespace

glm::dvec2 SampleStream::next() {
    const CounterRandom random = CounterRandom(seed_).sequence(pair_++);
    const std::uint64_t first = random(0), second = random(1);
    // Scrambling the index shuffles the order, and keeps each power of two of samples together.
    const std::uint32_t index = scrambled(index_, static_cast<std::uint32_t>(first));
    return {unit(scrambled(reversed(index), static_cast<std::uint32_t>(first >> 32))),
            unit(scrambled(sobol_second(index), static_cast<std::uint32_t>(second)))};
}

} // namespace graftal
