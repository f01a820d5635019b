#include "compiler/support/decimal_text.h"

#include <bit>
#include <cstring>

namespace graftal {

namespace {

constexpr std::array<char, 200> two_digits = [] {
    std::array<char, 200> text{};
    for (std::size_t i = 0; i < 100; ++i) {
        text[2 * i] = static_cast<char>('0' + i / 10);
        text[2 * i + 1] = static_cast<char>('0' + i % 10);
    }
    return text;
}();

/// Writes the digits of the number in front of `end`, and gives their beginning.
char* write_before(char* end, std::uint64_t number) {
    while (number >= 100) {
        end -= 2;
        std::memcpy(end, &two_digits[2 * (number % 100)], 2);
        number /= 100;
    }
    if (number >= 10) {
        end -= 2;
        std::memcpy(end, &two_digits[2 * number], 2);
        return end;
    }
    *--end = static_cast<char>('0' + number);
    return end;
}

} // namespace

int decimal_exponent(double value) {
    const int binary = static_cast<int>(std::bit_cast<std::uint64_t>(value) >> 52) - 1023;
    // 1233 / 4096 is log10(2) to four digits: never too large by more than the step below mends.
    int exponent = (binary * 1233) >> 12;
    const double next = exponent >= -1 ? power_of_ten[static_cast<std::size_t>(exponent + 1)]
                                       : 1 / power_of_ten[static_cast<std::size_t>(-exponent - 1)];
    if (value >= next) ++exponent;
    return exponent;
}

char* write_integer(char* out, std::uint64_t number) {
    char digits[20];
    char* const end = digits + sizeof digits;
    const char* const begin = write_before(end, number);
    std::memcpy(out, begin, static_cast<std::size_t>(end - begin));
    return out + (end - begin);
}

char* write_decimal(char* out, std::uint64_t number, int decimals) {
    char digits[20];
    const char* end = digits + sizeof digits;
    char* begin = write_before(digits + sizeof digits, number);
    const char* const point = end - decimals;
    while (begin >= point)
        *--begin = '0';
    while (end > point && end[-1] == '0')
        --end;
    std::memcpy(out, begin, static_cast<std::size_t>(point - begin));
    out += point - begin;
    if (end == point) return out;
    *out++ = '.';
    std::memcpy(out, point, static_cast<std::size_t>(end - point));
    return out + (end - point);
}

} // namespace graftal
