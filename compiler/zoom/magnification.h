#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace graftal {

/// A positive factor far beyond the range of doubles: mantissa * 2^exponent, 1 <= mantissa < 2.
struct Magnification {
    double mantissa = 1;
    std::int64_t exponent = 0;

    /// Exponents to the base 10 reach this far either way.
    static constexpr std::int64_t most_decimal_exponent = 1'000'000;

    double log2() const;
    /// length * this; infinite or 0 where no double holds it.
    double times(double length) const;
    bool operator==(const Magnification&) const = default;

    static Magnification of(double positive);
    /// 2^power. Requires a finite power.
    static Magnification exp2(double power);
    /// Reads `1e100`, `2.5`, `1e-3` or a power such as `2^330`; nothing if it is malformed or not positive.
    static std::optional<Magnification> parse(std::string_view text);
};

Magnification operator*(const Magnification& a, const Magnification& b);

} // namespace graftal
