#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace graftal {

/// Gives our text for a call of a function that we lack, from its name and its arguments as they are and in
/// our language. Nothing for functions that it does not know.
using CpfgCalls = std::function<std::optional<std::string>(std::string_view name,
                                                           std::span<const std::string_view> arguments,
                                                           std::span<const std::string> written)>;

/// An expression of cpfg in our language. `complain` hears of parts without a translation, after which the
/// text is of no use.
std::string translated_cpfg_expression(std::string_view text, const CpfgCalls& calls,
                                       const std::function<void(const std::string&)>& complain);

/// Where the first of these characters stands outside of all parentheses, from `begin` on; npos if nowhere.
std::size_t find_outside(std::string_view text, std::string_view characters, std::size_t begin = 0);

/// The parts between the commas outside of all parentheses, and of `[ ]` where they count, without blanks
/// around them; none of a blank text.
std::vector<std::string_view> split_outside(std::string_view text, bool squares_count = false);

/// The place behind the parenthesis that closes the one at `open`; npos if none does.
std::size_t end_of_parentheses(std::string_view text, std::size_t open);

/// Letters, digits and '_'.
bool is_cpfg_name(char c);

/// The name that stands at `begin`; "" for none.
std::string_view cpfg_name_at(std::string_view text, std::size_t begin = 0);

/// Whether a text is a name, and no number.
bool is_cpfg_parameter(std::string_view text);

} // namespace graftal
