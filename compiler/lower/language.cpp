#include "compiler/lower/language.h"

#include <algorithm>
#include <ranges>

#include <fmt/format.h>

#include "compiler/lower/lowering.h"
#include "compiler/primitives/mesh_file.h"
#include "compiler/support/alternatives.h"
#include "compiler/support/path_text.h"
#include "compiler/syntax/lexer.h"

namespace graftal {

namespace {

bool contains(std::span<const std::string_view> words, std::string_view word) {
    return std::ranges::find(words, word) != words.end();
}

/// The only language of whose keywords this is one; null if there is none or are several.
const Language* language_with(std::string_view keyword, std::span<const Language> languages) {
    const Language* found = nullptr;
    for (const Language& language : languages) {
        if (!contains(language.keywords, keyword)) continue;
        if (found) return nullptr;
        found = &language;
    }
    return found;
}

const Language& guessed_language(FileId file, const SourceMap& sources, std::span<const Language> languages) {
    const auto is_keyword = [&](const Token& token) {
        return std::ranges::any_of(languages,
                                   [&](const Language& l) { return contains(l.keywords, token.text); });
    };
    Diagnostics ignored; // the front-end reads the text again
    const std::vector<Token> tokens = lex(sources, file, ignored);
    std::size_t depth = 0;
    bool begins = false;
    for (std::size_t i = 0; i + 1 < tokens.size(); ++i) {
        const Token& token = tokens[i];
        if (token.is("{")) ++depth;
        if (token.is("}") && depth > 0) --depth;
        // One keyword may stand behind another: `main lsys NAME`; but in `use rifs = "..."` the second is a
        // name.
        const bool follows = begins && !tokens[i + 1].is("=");
        begins = depth == 0 && token.kind == TokenKind::name && (token.first_on_line || follows) &&
                 is_keyword(token);
        const Language* const language = begins ? language_with(token.text, languages) : nullptr;
        if (language) return *language;
    }
    return languages.back();
}

/// The words that a text of a language begins with.
std::vector<std::string> first_words(const Language& language) {
    std::vector<std::string> words(language.keywords.begin(), language.keywords.end());
    words.insert(words.end(), scene_keywords().begin(), scene_keywords().end());
    return words;
}

/// How to name a file that begins as no text of its language does, but as one of another; "" for other files.
std::string other_language_hint(FileId file, const Language& own, const Lowering& lowering) {
    const std::string_view first = lex_beginning(lowering.sources, file)[0].text;
    const std::vector<std::string> words = first_words(own);
    if (std::ranges::find(words, first) != words.end() || contains(own.inner_keywords, first) ||
        !closest_name(first, words).empty())
        return {};
    for (const Language& other : lowering.languages)
        if (contains(other.inner_keywords, first))
            return fmt::format("models with '{}' are files whose names end in .{}", first, other.extension);
    return {};
}

/// Whether the first statement is one, or a misspelt one. Who names another file by mistake, or by the
/// mistake of a stranger's link, must not see it printed line by line as bad syntax.
bool looks_like_model(FileId file, const SourceMap& sources, std::span<const Language> languages) {
    std::vector<Token> tokens = lex_beginning(sources, file);
    if (Diagnostics ignored; tokens.size() < 3) tokens = lex(sources, file, ignored);
    if (tokens.size() == 1) return true; // empty, as the front-end will say
    const Token& first = tokens[0];
    const Token& second = tokens[1];
    if (first.kind != TokenKind::name) return first.is("}") || first.is("{") || first.is(";");
    for (const Language& language : languages) {
        const std::vector<std::string> words = first_words(language);
        if (contains(language.inner_keywords, first.text)) return true;
        if (std::find(words.begin(), words.end(), first.text) != words.end()) return true;
        if (!closest_name(first.text, words).empty()) return true;
    }
    return second.is("{") || second.is("=") || second.is("->");
}

} // namespace

const Language* language_with_ending(std::string_view ending, std::span<const Language> languages) {
    const auto found = std::ranges::find_if(languages, [&](const Language& language) {
        return ending == fmt::format(".{}", language.extension);
    });
    return found == languages.end() ? nullptr : &*found;
}

const Language* language_of(FileId file, const SourceMap& sources, std::span<const Language> languages) {
    const std::string_view name = sources.name(file);
    if (name == standard_input) return &guessed_language(file, sources, languages);
    return language_with_ending(extension_of(name), languages);
}

std::unique_ptr<const ModelTree> parse_model(const Language& language, FileId file, const SourceMap& sources,
                                             std::span<const Language> languages, Diagnostics& diagnostics) {
    ForeignWords foreign;
    for (const Language& other : languages)
        for (const std::string_view word : other.keywords)
            if (&other != &language && language_with(word, languages)) foreign.emplace(word, other.extension);
    return language.parse(sources, file, foreign, diagnostics);
}

std::string extensions(std::span<const Language> languages) {
    return alternatives(languages,
                        [](const Language& language) { return fmt::format(".{}", language.extension); });
}

std::optional<Graph> lower_file(FileId file, Span asked_for, Lowering& lowering) {
    if (lowering.diagnostics.full()) { // front-ends stop there, so that none may begin
        ++lowering.known_failures;
        return std::nullopt;
    }
    const std::string_view name = lowering.sources.name(file);
    const Language* const language = language_of(file, lowering.sources, lowering.languages);
    // Without the text: of what is no model nothing is shown.
    const Span place = asked_for.file == file ? Span() : asked_for;
    if (!language) {
        lowering.diagnostics.error(place, fmt::format("'{}' is no model that is known here", name))
            .with_hint(
                is_mesh_name(name)
                    ? fmt::format("a mesh is a part of a model: write 'object thing {{ mesh \"{}\" }}' "
                                  "into an .inst file beside it",
                                  file_name_of(name))
                    : fmt::format("the names of models end in {}; files of other programs, such as .cfdg, "
                                  ".es, .l, .ifs and .flame, are models too",
                                  extensions(lowering.languages)));
        return std::nullopt;
    }
    const std::string other = other_language_hint(file, *language, lowering);
    if (!other.empty() || !looks_like_model(file, lowering.sources, lowering.languages)) {
        lowering.diagnostics
            .error(place, fmt::format("'{}' is no model: its first word begins no statement", name))
            .with_hint(other.empty() ? choices("", first_words(*language)) : other);
        return std::nullopt;
    }
    lowering.loading.back().failures_before = lowering.failures();
    return lowering.parsed.tree(*language, file, lowering.sources, lowering.languages, lowering.diagnostics)
        .lower(lowering);
}

} // namespace graftal
