#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace graftal {

/// The likely meaning of a character beyond ASCII. Word processors and web pages put typographic quotes,
/// dashes, arrows, full-width letters and spaces of many kinds in place of the characters of the languages.
struct Lookalike {
    std::string_view meant; ///< `"`, `-`, `->`, `{`, `3`, a blank, ...; static storage
    std::string_view name;  ///< "a typographic quote"; static storage
};

std::optional<Lookalike> lookalike(char32_t character);

/// A letter that no name may have, such as é.
bool is_foreign_letter(char32_t character);

/// The message "unexpected character 'x'", or its number where one cannot see it. `character` is all its
/// bytes.
std::string unexpected_character(std::string_view character);

/// A hint that says what to write in place of the character, or "".
std::string lookalike_hint(std::string_view character);

} // namespace graftal
