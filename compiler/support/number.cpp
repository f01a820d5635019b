#include "compiler/support/number.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <system_error>

#include "compiler/support/decimal_text.h"

namespace graftal {

namespace {

/// POV-Ray and people read "1e-05" and "1e-5" alike; to_chars is already locale-proof.
template<typename... Format> void append_chars(std::string& out, double value, Format... format) {
    char buffer[64];
    if (value == 0) value = 0; // drops the sign of -0
    const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, value, format...);
    out.append(buffer, error == std::errc() ? end : buffer);
}

/// Appends what general format gives, if that has no exponent and its rounding is beyond doubt. Many times
/// faster than the conversion that is right for every number.
bool append_plain(std::string& out, double value, int digits) {
    constexpr double doubt = 1e-3; // the product below is wrong by less
    if (!(value >= 1e-4 && digits >= 1 && digits <= 12) ||
        value >= power_of_ten[static_cast<std::size_t>(digits)])
        return false;
    const int shift = digits - 1 - decimal_exponent(value);
    const double scaled = value * power_of_ten[static_cast<std::size_t>(shift)];
    auto number = static_cast<std::uint64_t>(scaled);
    const double rest = scaled - static_cast<double>(number);
    if (std::abs(rest - 0.5) < doubt) return false;
    if (rest > 0.5) ++number;
    if (static_cast<double>(number) >= power_of_ten[static_cast<std::size_t>(digits)]) return false;
    char buffer[24];
    out.append(buffer, write_decimal(buffer, number, shift));
    return true;
}

/// Whether a number text that is out of range is too small for a double; else it is too large. Tells by the
/// decimal place of the first digit that is not 0.
bool underflows(std::string_view text) {
    const std::size_t e = std::min(text.find_first_of("eE"), text.size());
    const std::string_view mantissa = text.substr(0, e);
    const std::string_view exponent = text.substr(std::min(e + 1, text.size()));
    long long shift = 0;
    if (std::from_chars(exponent.data(), exponent.data() + exponent.size(), shift).ec ==
        std::errc::result_out_of_range)
        return exponent.starts_with('-');
    const auto dot = static_cast<long long>(std::min(mantissa.find('.'), mantissa.size()));
    const auto first_digit = static_cast<long long>(mantissa.find_first_of("123456789"));
    return shift < first_digit - dot;
}

} // namespace

std::string shortest(double value) {
    std::string out;
    append_chars(out, value);
    return out;
}

void append_number(std::string& out, double value, int digits) {
    if (append_plain(out, value, digits)) return;
    append_chars(out, value, std::chars_format::general, digits);
}

#ifdef __cpp_lib_to_chars
std::from_chars_result read_double(const char* first, const char* last, double& value) {
    return std::from_chars(first, last, value);
}
#else // libc++ before 20. Its programs have the locale "C".
std::from_chars_result read_double(const char* first, const char* last, double& value) {
    // strtod() reads more: white space, "+" and hexadecimal digits.
    const char* begin = first;
    if (begin != last && *begin == '-') ++begin;
    if (begin == last || std::string_view(" \t\n\v\f\r+-").find(*begin) != std::string_view::npos)
        return {first, std::errc::invalid_argument};
    if (last - begin > 1 && *begin == '0' && (begin[1] == 'x' || begin[1] == 'X')) {
        value = 0;
        return {begin + 1, std::errc()};
    }
    constexpr std::string_view letters = "0123456789.eE+-infatyINFATY";
    const std::string text(
        first, std::find_if(first, last, [&](char c) { return letters.find(c) == std::string_view::npos; }));
    char* end = nullptr;
    errno = 0;
    const double read = std::strtod(text.c_str(), &end);
    if (end == text.c_str()) return {first, std::errc::invalid_argument};
    const char* const stop = first + (end - text.c_str());
    if (errno == ERANGE) return {stop, std::errc::result_out_of_range};
    value = read;
    return {stop, std::errc()};
}
#endif

std::optional<double> parse_number(std::string_view text) {
    double value = 0;
    const auto [end, error] = read_double(text.data(), text.data() + text.size(), value);
    if (end != text.data() + text.size()) return std::nullopt;
    if (error == std::errc::result_out_of_range && underflows(text)) return 0;
    if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
    return value;
}

} // namespace graftal
