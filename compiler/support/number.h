#pragma once

#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

namespace graftal {

/// The shortest decimal text that reads back as the same double, whatever the locale; -0 prints as 0.
std::string shortest(double value);

/// Appends `value` with at most `digits` significant digits, without trailing zeros; locale-proof.
void append_number(std::string& out, double value, int digits);

/// std::from_chars() of a double, which not every library has.
std::from_chars_result read_double(const char* first, const char* last, double& value);

/// Reads all of `text` as a decimal number; nothing if it is malformed, overflows or is no number ("inf"). A
/// number too small for a double is 0.
std::optional<double> parse_number(std::string_view text);

/// Reads all of `text` as a whole number; nothing if it is malformed or overflows.
template<typename Whole> std::optional<Whole> parse_whole(std::string_view text) {
    Whole value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

} // namespace graftal
