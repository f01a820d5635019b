#include <optional>
#include <utility>

#include "compiler/import/foreign_text.h"
#include "compiler/import/formats.h"
#include "compiler/import/lpy/system.h"

namespace graftal {

namespace {

/// An axiom with a colon, and another statement of L-Py. cpfg has these too, and begins with "Lsystem:".
bool is_lpy(std::string_view text) {
    bool axiom = false, other = false;
    for (const TextLine& line : lines_of(text, 0, text.size())) {
        const std::string_view words = trimmed(line.text);
        if (words.starts_with("Lsystem:") || words.starts_with("lsystem:")) return false;
        const auto begins = [&](std::string_view word) {
            return words.starts_with(word) && trimmed(words.substr(word.size())).starts_with(':');
        };
        axiom = axiom || begins("Axiom");
        other = other || begins("production") || begins("derivation length") || begins("interpretation") ||
                begins("homomorphism");
    }
    return axiom && other;
}

std::optional<Translation> translate_lpy(const ForeignFile& file, const ForeignModel& model) {
    std::optional<LSystem> system = read_lpy(file);
    if (!system) return std::nullopt;
    return write_lpy(file, model, std::move(*system));
}

constexpr std::string_view lpy_endings[] = {"lpy"};

} // namespace

Importer lpy_importer() {
    return {.format = "L-Py",
            .endings = lpy_endings,
            .recognises = is_lpy,
            .sign = "lines 'Axiom: ...' and 'production:'",
            .models = one_model,
            .translation = translate_lpy,
            .host = "a Python program",
            .most_bytes = 1'000'000};
}

} // namespace graftal
