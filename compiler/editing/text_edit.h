#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace graftal {

/// Puts `text` in place of the bytes [begin, end).
struct TextEdit {
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
    std::string text;

    bool operator==(const TextEdit&) const = default;
};

/// The text after all edits, which speak of the text before them. Requires ranges inside of the text that do
/// not overlap, in any order; edits at one place stay in their order.
std::string applied(std::string_view text, std::vector<TextEdit> edits);

} // namespace graftal
