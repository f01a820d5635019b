#include "compiler/zoom/magnification.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "compiler/support/number.h"

namespace graftal {

namespace {

std::optional<std::int64_t> parse_exponent(std::string_view text) {
    constexpr std::int64_t most = 1'000'000'000'000'000'000;
    if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value < -most || value > most ? std::nullopt : std::optional(value);
}

/// base^exponent by repeated squaring: exact for powers of two, else to about log2(exponent) roundings.
Magnification power(Magnification base, std::int64_t exponent) {
    if (exponent < 0) {
        base = Magnification::of(1 / base.mantissa) * Magnification{1, -base.exponent};
        exponent = -exponent;
    }
    Magnification result;
    for (; exponent > 0; exponent /= 2) {
        if (exponent % 2 != 0) result = result * base;
        base = base * base;
    }
    return result;
}

std::optional<Magnification> positive(std::optional<double> value) {
    if (!value || !std::isfinite(*value) || !(*value > 0)) return std::nullopt;
    return Magnification::of(*value);
}

} // namespace

double Magnification::log2() const {
    return std::log2(mantissa) + static_cast<double>(exponent);
}

double Magnification::times(double length) const {
    constexpr std::int64_t beyond = 10'000; // of any double
    return std::ldexp(length * mantissa, static_cast<int>(std::clamp(exponent, -beyond, beyond)));
}

Magnification Magnification::of(double value) {
    int exponent = 0;
    const double half = std::frexp(value, &exponent);
    return {2 * half, exponent - 1};
}

Magnification Magnification::exp2(double power) {
    const double whole = std::floor(power);
    return Magnification::of(std::exp2(power - whole)) * Magnification{1, static_cast<std::int64_t>(whole)};
}

std::optional<Magnification> Magnification::parse(std::string_view text) {
    if (const std::size_t caret = text.find('^'); caret != std::string_view::npos) {
        const auto base = positive(parse_number(text.substr(0, caret)));
        const auto exponent = parse_exponent(text.substr(caret + 1));
        if (!base || !exponent) return std::nullopt;
        const double digits = std::abs(base->log2() * static_cast<double>(*exponent)) * std::log10(2.0);
        if (!(digits <= static_cast<double>(most_decimal_exponent))) return std::nullopt;
        return power(*base, *exponent);
    }
    const std::size_t e = text.find_first_of("eE");
    if (e == std::string_view::npos) return positive(parse_number(text));
    const auto exponent = parse_exponent(text.substr(e + 1));
    if (!exponent || std::abs(*exponent) > most_decimal_exponent) return std::nullopt;
    // A number that a double can hold is read as one, to the last bit.
    constexpr std::int64_t safe = 290;
    if (std::abs(*exponent) <= safe) return positive(parse_number(text));
    const auto mantissa = positive(parse_number(text.substr(0, e)));
    if (!mantissa) return std::nullopt;
    return *mantissa * power(of(10), *exponent);
}

Magnification operator*(const Magnification& a, const Magnification& b) {
    Magnification product = Magnification::of(a.mantissa * b.mantissa);
    product.exponent += a.exponent + b.exponent;
    return product;
}

} // namespace graftal
