#include "compiler/import/lparser.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "compiler/import/foreign_text.h"
#include "compiler/import/lparser_system.h"

namespace graftal {

namespace {

constexpr std::size_t most_file_bytes =
    1'000'000; ///< of a file: its strings have fewer modules than ours may

std::vector<ForeignModel> lparser_models(const ForeignFile& file) {
    const std::string name = std::filesystem::path(file.sources.name(file.file)).stem().string();
    return {{name, file.span(0, std::min<std::size_t>(file.text().find('\n'), file.text().size()))}};
}

/// No other format ends in .ls.
bool is_lparser(std::string_view text) {
    return !is_binary(text);
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
    return {"L-Parser", lparser_endings, is_lparser, lparser_models, translate_lparser};
}

} // namespace graftal
