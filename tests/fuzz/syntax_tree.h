#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace graftal::fuzz {

/// What a part of a text is: the whole, a statement or line of a block, `{...}`, `(...)` or `<...>`, `[...]`,
/// one of several that commas part, a name with its `(...)`, and what has no parts.
enum class Part : std::uint8_t {
    text,
    statement,
    block,
    list,
    branch,
    item,
    call,
    number,
    word,
    string,
    mark
};

inline constexpr std::size_t part_count = 11;

/// A part of a text, from `begin` to before `end`.
struct SyntaxNode {
    Part part = Part::text;
    std::size_t begin = 0;
    std::size_t end = 0;
    std::string_view
        key; ///< the first word of a statement, the name of a call, the text of what has no parts
    std::string_view
        within; ///< the key of the statement around it: what may stand in its place is likely within the same
};

/// The syntax tree of a text in any of the three languages, coarse enough to hold for all: parents stand
/// before their parts, and the first is the text. Nothing if brackets do not match, or nest deeper than 64.
/// O(text).
std::optional<std::vector<SyntaxNode>> read_syntax(std::string_view text);

} // namespace graftal::fuzz
