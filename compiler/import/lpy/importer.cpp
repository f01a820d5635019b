#include "compiler/import/lpy/importer.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "compiler/import/foreign_text.h"
#include "compiler/import/lpy/system.h"
#include "compiler/support/path_text.h"

namespace graftal {

namespace {

constexpr std::size_t most_lpy_bytes = 1'000'000;

std::vector<ForeignModel> lpy_models(const ForeignFile& file) {
    const std::string name(stem_of(file.sources.name(file.file)));
    return {{name, file.span(0, std::min<std::size_t>(file.text().find('\n'), file.text().size()))}};
}

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
    if (file.text().size() > most_lpy_bytes) {
        file.diagnostics.error(file.span(0, 0),
                               fmt::format("a file of L-Py has at most {} characters", most_lpy_bytes));
        return std::nullopt;
    }
    std::optional<CpfgSystem> system = read_lpy(file);
    if (!system) return std::nullopt;
    return write_lpy(file, model, std::move(*system));
}

constexpr std::string_view lpy_endings[] = {"lpy"};

} // namespace

Importer lpy_importer() {
    return {"L-Py",        lpy_endings,       is_lpy, "lines 'Axiom: ...' and 'production:'", lpy_models,
            translate_lpy, "a Python program"};
}

} // namespace graftal
