#include "compiler/lsys/variants.h"

#include <bit>

#include "compiler/support/counter_random.h"

namespace graftal {

namespace {

constexpr auto scrambled = CounterRandom::scrambled;

std::uint64_t key_of(std::uint64_t seed, ModuleId module, std::uint32_t stage, std::uint64_t place) {
    return scrambled(scrambled(scrambled(seed) ^ ((std::uint64_t{module} << 32) | stage)) ^ place);
}

} // namespace

/// Odd factors, additions and shifts are bijections of the numbers below a power of two.
std::uint32_t Variants::permuted(std::uint32_t variant, std::uint64_t key) const {
    const int half = (std::bit_width(mask_) + 1) / 2;
    for (int round = 0; round < 3; ++round) {
        key = scrambled(key);
        variant = (variant * (static_cast<std::uint32_t>(key) | 1u) + static_cast<std::uint32_t>(key >> 32)) &
                  mask_;
        variant ^= variant >> half;
    }
    return variant;
}

std::uint32_t Variants::child(std::uint32_t variant, ModuleId parent, std::uint32_t stage,
                              std::size_t place) const {
    return mask_ == 0 ? 0 : permuted(variant, key_of(seed_, parent, stage, place));
}

ChosenAlternative Variants::choose(const std::vector<Alternative>& alternatives, std::uint32_t variant,
                                   ModuleId module, std::uint32_t stage) const {
    constexpr std::uint64_t of_choice = UINT64_MAX; // no place in a string
    const std::uint64_t key = key_of(seed_, module, stage, of_choice);
    const double inside = CounterRandom::unit(scrambled(key ^ variant));
    return alternative_at(alternatives, (permuted(variant, key) + inside) / count());
}

} // namespace graftal
