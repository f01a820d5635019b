#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

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

} // namespace graftal
