#include "tests/fuzz/fuzz_targets.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#define GRAFTAL_FUZZ_TARGET(name, texts) extern "C" int graftal_fuzz_##name(const std::uint8_t*, std::size_t);
#include "fuzz_targets.inc"
#undef GRAFTAL_FUZZ_TARGET

namespace graftal::fuzz {

namespace {

const Input& one_of(const std::vector<Input>& inputs, testing::Choices& choices) {
    return inputs[choices.below(static_cast<std::uint32_t>(inputs.size()))];
}

/// A byte changed, bytes taken out, or bytes of another input put in.
void change_bytes(std::string& bytes, const std::string& other, testing::Choices& choices) {
    if (bytes.empty()) return;
    const std::size_t at = choices.below(static_cast<std::uint32_t>(bytes.size()));
    switch (choices.below(4)) {
    case 0:
        bytes.erase(at, 1 + choices.below(8));
        break;
    case 1:
        if (!other.empty())
            bytes.insert(at, other, choices.below(static_cast<std::uint32_t>(other.size())),
                         1 + choices.below(32));
        break;
    default:
        bytes[at] = static_cast<char>(static_cast<unsigned char>(choices.below(256)));
    }
}

} // namespace

std::vector<Target> targets() {
    return {
#define GRAFTAL_FUZZ_TARGET(name, texts) Target{#name, graftal_fuzz_##name, texts},
#include "fuzz_targets.inc"
#undef GRAFTAL_FUZZ_TARGET
    };
}

std::vector<Input> files_of(const std::string& folder) {
    std::vector<Input> inputs;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        std::ifstream file(entry.path(), std::ios::binary);
        inputs.push_back(
            {entry.path().filename().string(), std::string(std::istreambuf_iterator<char>(file), {})});
    }
    std::sort(inputs.begin(), inputs.end(), [](const Input& a, const Input& b) { return a.name < b.name; });
    return inputs;
}

std::string changed(const Target& target, const std::vector<Input>& inputs, std::size_t most,
                    SyntaxMutator& mutator, testing::Choices& choices) {
    std::string bytes = one_of(inputs, choices).bytes;
    std::uint32_t byte_changes = 1 + choices.below(4);
    if (target.texts) {
        mutator.learn(bytes, choices);
        std::string text = mutator.mutate(bytes, most, choices);
        if (!text.empty()) bytes = std::move(text);
        if (!choices.one_in(12)) byte_changes = 0;
    }
    for (; byte_changes > 0; --byte_changes)
        change_bytes(bytes, one_of(inputs, choices).bytes, choices);
    return bytes;
}

} // namespace graftal::fuzz
