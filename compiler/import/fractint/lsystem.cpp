#include <algorithm>
#include <cctype>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "compiler/import/foreign_text.h"
#include "compiler/import/formats.h"
#include "compiler/import/fractint/system.h"
#include "compiler/support/small_letters.h"

namespace graftal {

namespace {

constexpr std::size_t most_bytes = 1'000'000; ///< of a model: its strings have fewer modules than ours may

/// Calls `see(name_begin, name_end, body_begin, body_end)` for each block; false where one never ends.
template<typename See> bool each_block(std::string_view text, const See& see) {
    std::size_t name_begin = 0;
    for (std::size_t at = 0; at < text.size(); ++at) {
        if (text[at] == ';') {
            at = std::min(text.find('\n', at), text.size());
            name_begin = at + 1;
        } else if (text[at] == '\n') {
            // A name may stand before the line of the brace. Lines without a name are not looked beyond.
            const bool blank = trimmed(text.substr(name_begin, at - name_begin)).empty();
            const std::size_t next = blank ? at : text.find_first_not_of(" \t\r\n", at);
            if (next != std::string_view::npos && text[next] == '{')
                at = next - 1;
            else
                name_begin = at + 1;
        } else if (text[at] == '{') {
            std::size_t end = at + 1;
            while (end < text.size() && text[end] != '}')
                end = text[end] == ';' ? std::min(text.find('\n', end), text.size()) : end + 1;
            see(name_begin, at, at + 1, std::min(end, text.size()));
            if (end >= text.size()) return false;
            at = end;
            name_begin = end + 1;
        }
    }
    return true;
}

std::vector<ForeignModel> fractint_models(const ForeignFile& file) {
    std::vector<ForeignModel> models;
    std::set<std::string> names;
    const std::string_view text = file.text();
    const bool whole = each_block(
        text, [&](std::size_t name_begin, std::size_t name_end, std::size_t begin, std::size_t end) {
            std::string_view name = trimmed(text.substr(name_begin, name_end - name_begin));
            name = trimmed(name.substr(0, name.find_first_of("( \t\r\n")));
            if (name.empty() || in_small_letters(name) == "comment") return;
            if (names.insert(in_small_letters(name)).second)
                models.push_back({std::string(name), file.span(begin, end)});
            else
                file.diagnostics.warning(file.span(name_begin, name_end),
                                         fmt::format("a second '{}': only the first can be named", name));
        });
    if (!whole)
        file.diagnostics.warning(file.span(text.size(), text.size()),
                                 "the last block of the file has no '}'");
    return models;
}

/// A block that has an axiom or an angle, and no colon behind the word, as those of cpfg have.
bool is_fractint_lsystem(std::string_view text) {
    bool found = false;
    each_block(text, [&](std::size_t, std::size_t, std::size_t begin, std::size_t end) {
        if (found) return;
        for (const TextLine& line : lines_of(text, begin, end)) {
            const std::string small = in_small_letters(trimmed(line.text));
            const bool statement = small.starts_with("axiom") || small.starts_with("angle");
            found = found ||
                    (statement && small.size() > 5 && std::isspace(static_cast<unsigned char>(small[5])));
        }
    });
    return found;
}

std::optional<Translation> translate_fractint(const ForeignFile& file, const ForeignModel& model) {
    if (model.span.end - model.span.begin > most_bytes) {
        file.diagnostics.error(file.span(model.span.begin, model.span.begin),
                               fmt::format("a model has more than {} characters", most_bytes));
        return std::nullopt;
    }
    std::optional<FractintSystem> system = read_fractint_system(file, model);
    if (!system) return std::nullopt;
    return write_fractint_system(file, model, *std::move(system));
}

constexpr std::string_view fractint_lsystem_endings[] = {"l"};

} // namespace

Importer fractint_lsystem_importer() {
    return {"Fractint L-system", fractint_lsystem_endings,
            is_fractint_lsystem, "a block 'name { Angle 6 ... }' with an axiom",
            fractint_models,     translate_fractint};
}

} // namespace graftal
