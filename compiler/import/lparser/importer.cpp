#include "compiler/import/lparser/importer.h"

#include <algorithm>

#include <fmt/format.h>

#include "compiler/import/foreign_text.h"
#include "compiler/import/lparser/system.h"
#include "compiler/support/path_text.h"

namespace graftal {

namespace {

constexpr std::size_t most_file_bytes =
    1'000'000; ///< of a file: its strings have fewer modules than ours may

std::vector<ForeignModel> lparser_models(const ForeignFile& file) {
    const std::string name(stem_of(file.sources.name(file.file)));
    return {{name, file.span(0, std::min<std::size_t>(file.text().find('\n'), file.text().size()))}};
}

/// Lines of depth, angle, thickness and axiom; or a keyword first, and an axiom.
bool is_lparser(std::string_view text) {
    constexpr std::size_t numbers = 3;
    std::size_t statements = 0;
    bool keywords = false;
    for (const TextLine& line : lines_of(text, 0, text.size())) {
        const std::string_view words = trimmed(line.text.substr(0, line.text.find('#')));
        if (words.empty()) continue;
        const std::string_view word = words.substr(0, words.find_first_of(" \t"));
        if (statements == 0) keywords = is_lparser_keyword(word);
        if (keywords && word == "axiom") return true;
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
    if (file.text().size() > most_file_bytes) {
        file.diagnostics.error(file.span(0, 0),
                               fmt::format("a file of L-Parser has at most {} characters", most_file_bytes));
        return std::nullopt;
    }
    const std::optional<LparserSystem> system = read_lparser(file);
    if (!system) return std::nullopt;
    return write_lparser(file, model, *system);
}

constexpr std::string_view lparser_endings[] = {"ls"};

} // namespace

Importer lparser_importer() {
    return {"L-Parser",     lparser_endings,
            is_lparser,     "lines of recursion depth, angle, thickness, axiom and rules",
            lparser_models, translate_lparser};
}

} // namespace graftal
