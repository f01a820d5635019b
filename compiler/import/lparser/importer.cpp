#include <optional>
#include <utility>

#include "compiler/import/bourke/bourke.h"
#include "compiler/import/foreign_text.h"
#include "compiler/import/formats.h"
#include "compiler/import/lparser/system.h"

namespace graftal {

namespace {

/// Lines of depth, angle, thickness and axiom; or a keyword first, and an axiom. Bourke's lines begin with
/// the same words, and their rules have arrows.
bool is_lparser(std::string_view text) {
    constexpr std::size_t numbers = 3;
    std::size_t statements = 0;
    bool keywords = false;
    for (const TextLine& line : lines_of(text, 0, text.size())) {
        const std::string_view words = trimmed(line.text.substr(0, line.text.find('#')));
        if (words.empty()) continue;
        const std::string_view word = words.substr(0, words.find_first_of(" \t"));
        if (statements == 0) keywords = is_lparser_keyword(word);
        if (keywords && word == "axiom") return !is_bourke(text);
        if (!keywords && statements == numbers) return true;
        if (!keywords && leading_number(word).length != word.size()) return false;
        // A table of numbers is another program's: one number stands on a line here, with words after it at
        // most.
        if (!keywords && leading_number(trimmed(words.substr(word.size()))).length > 0) return false;
        ++statements;
    }
    return false;
}

std::optional<Translation> translate_lparser(const ForeignFile& file, const ForeignModel& model) {
    std::optional<LparserSystem> system = read_lparser(file);
    if (!system) return std::nullopt;
    return write_lparser(file, model, *std::move(system));
}

constexpr std::string_view lparser_endings[] = {"ls"};

} // namespace

Importer lparser_importer() {
    return {.format = "L-Parser",
            .endings = lparser_endings,
            .recognises = is_lparser,
            .sign = "lines of recursion depth, angle, thickness, axiom and rules",
            .models = one_model,
            .translation = translate_lparser,
            .most_bytes = 1'000'000}; // its strings have fewer modules than ours may
}

} // namespace graftal
