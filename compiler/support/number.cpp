#include "compiler/support/number.h"

#include <charconv>
#include <cmath>

namespace graftal {

namespace {

/// POV-Ray and people read "1e-05" and "1e-5" alike; to_chars is already locale-proof.
template <typename... Format>
void append_chars(std::string& out, double value, Format... format) {
    char buffer[64];
    if (value == 0) value = 0;  // drops the sign of -0
    const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, value, format...);
    out.append(buffer, error == std::errc() ? end : buffer);
}

}  // namespace

std::string shortest(double value) {
    std::string out;
    append_chars(out, value);
    return out;
}

void append_number(std::string& out, double value, int digits) {
    append_chars(out, value, std::chars_format::general, digits);
}

std::optional<double> parse_number(std::string_view text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

}  // namespace graftal
