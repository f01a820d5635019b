#include "runtime/trace/shade/sample_stream.h"

#include "compiler/support/counter_random.h"
#include "runtime/trace/shade/formulas.h"

namespace graftal {

namespace {

double unit(std::uint32_t x) {
    return x * 0x1p-32;
}

} // namespace

glm::dvec2 SampleStream::next() {
    const CounterRandom random = CounterRandom(seed_).sequence(pair_++);
    const std::uint64_t first = random(0), second = random(1);
    // Scrambling the index shuffles the order, and keeps each power of two of samples together.
    const std::uint32_t index = formulas::scrambled_bits(index_, static_cast<std::uint32_t>(first));
    return {unit(formulas::scrambled_first(index, static_cast<std::uint32_t>(first >> 32))),
            unit(formulas::scrambled_second(index, static_cast<std::uint32_t>(second)))};
}

} // namespace graftal
