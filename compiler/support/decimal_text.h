#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace graftal {

/// Powers of ten that both a double and a 64-bit integer hold exactly.
inline constexpr std::array<double, 20> power_of_ten = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,
                                                        1e7,  1e8,  1e9,  1e10, 1e11, 1e12, 1e13,
                                                        1e14, 1e15, 1e16, 1e17, 1e18, 1e19};

/// floor(log10(value)) for 1e-7 <= value < 1e15.
int decimal_exponent(double value);

/// Writes the number, and gives its end: at most 20 bytes.
char* write_integer(char* out, std::uint64_t number);

/// Writes number / 10^decimals in decimal, without trailing zeros behind the point, and gives its end: at
/// most 22 bytes. Requires decimals < 20.
char* write_decimal(char* out, std::uint64_t number, int decimals);

} // namespace graftal
