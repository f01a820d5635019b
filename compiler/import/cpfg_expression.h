#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace graftal {

/// What an expression of cpfg is in our language. `table_of`: the name of the table of a function `func(id,
/// x)`, by the text of its id; nothing if there is none. `complain` hears of what has no translation, after
/// which the text is of no use.
std::string
translated_cpfg_expression(std::string_view text,
                           const std::function<std::optional<std::string>(std::string_view id)>& table_of,
                           const std::function<void(const std::string&)>& complain);

/// Where the first of these characters stands outside of all parentheses, from `begin` on; npos if nowhere.
std::size_t find_outside(std::string_view text, std::string_view characters, std::size_t begin = 0);

} // namespace graftal
