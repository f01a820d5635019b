// What libFuzzer calls to change and to cross inputs that are texts: by their syntax trees mostly, by their
// bytes where they have none and now and then.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "tests/fuzz/syntax_mutator.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace {

graftal::fuzz::SyntaxMutator& mutator() {
    static graftal::fuzz::SyntaxMutator one;
    return one;
}

std::string_view text_of(const std::uint8_t* data, std::size_t size) {
    return {reinterpret_cast<const char*>(data), size};
}

} // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most,
                                               unsigned seed) {
    graftal::testing::Choices choices(seed);
    const std::string_view text = text_of(data, size);
    mutator().learn(text, choices);
    if (choices.one_in(12)) return LLVMFuzzerMutate(data, size, most);
    const std::string result = mutator().mutate(text, most, choices);
    if (result.empty()) return LLVMFuzzerMutate(data, size, most);
    std::memcpy(data, result.data(), result.size());
    return result.size();
}

extern "C" std::size_t LLVMFuzzerCustomCrossOver(const std::uint8_t* one, std::size_t one_size,
                                                 const std::uint8_t* two, std::size_t two_size,
                                                 std::uint8_t* out, std::size_t most, unsigned seed) {
    graftal::testing::Choices choices(seed);
    graftal::fuzz::SyntaxMutator crossing;
    crossing.learn(text_of(two, two_size), choices);
    const std::string result = crossing.mutate(text_of(one, one_size), most, choices);
    std::memcpy(out, result.data(), result.size());
    return result.size();
}
