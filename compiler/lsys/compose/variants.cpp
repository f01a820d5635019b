#include "compiler/lsys/compose/variants.h"

#include "compiler/lower/permutation.h"

namespace graftal {

namespace {

constexpr auto scrambled = CounterRandom::scrambled;

std::uint64_t key_of(std::uint64_t seed, ModuleId module, std::uint32_t stage, std::uint64_t place) {
    return scrambled(scrambled(scrambled(seed) ^ ((std::uint64_t{module} << 32) | stage)) ^ place);
}

} // namespace

std::uint32_t Variants::child(std::uint32_t variant, ModuleId parent, std::uint32_t stage,
                              std::size_t place) const {
    return mask_ == 0 ? 0 : permuted(variant, mask_, key_of(seed_, parent, stage, place));
}

Winner<Alternative> Variants::choose(const std::vector<Alternative>& alternatives, std::uint32_t variant,
                                     ModuleId module, std::uint32_t stage) const {
    constexpr std::uint64_t of_choice = UINT64_MAX; // no place in a string
    const std::uint64_t key = key_of(seed_, module, stage, of_choice);
    return graftal::choose(alternatives.data(), draw_at(stratified(variant, mask_, key)));
}

} // namespace graftal
