#include "compiler/syntax/lost_product.h"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>

namespace graftal {

std::string lost_product_hint(const Token& before, const Token& token) {
    constexpr std::array<std::string_view, 7> units = {"deg", "degrees", "rad", "px", "cm", "mm", "in"};
    constexpr std::size_t longest_shown = 40;
    if (before.kind != TokenKind::number || token.space_before || token.first_on_line) return {};
    if (std::max(before.text.size(), token.text.size()) > longest_shown) return {};
    if (token.is("(")) return fmt::format("write {}*(...)", before.text);
    if (token.kind != TokenKind::name) return {};
    if (std::ranges::find(units, token.text) != units.end())
        return fmt::format("write the number without a unit: {}", before.text);
    return fmt::format("write {}*{}", before.text, token.text);
}

} // namespace graftal
