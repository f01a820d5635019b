#include "compiler/emit/sdl_writer.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>

#include <glm/common.hpp>

#include "compiler/support/check.h"

namespace graftal {

namespace {

constexpr int placement_digits = 9;
constexpr double noise_share = 1e-13;
constexpr std::size_t longest_number = 40;

/// Powers of ten that both a double and a 64-bit integer hold exactly.
constexpr std::array<double, 20> power_of_ten = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,
                                                 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19};

/// floor(log10(value)) for 1e-7 <= value < 1e15.
int decimal_exponent(double value) {
    const int binary = static_cast<int>(std::bit_cast<std::uint64_t>(value) >> 52) - 1023;
    // 1233 / 4096 is log10(2) to four digits: never too large by more than the step below mends.
    int exponent = (binary * 1233) >> 12;
    const double next = exponent >= -1 ? power_of_ten[static_cast<std::size_t>(exponent + 1)]
                                       : 1 / power_of_ten[static_cast<std::size_t>(-exponent - 1)];
    if (value >= next) ++exponent;
    return exponent;
}

/// Writes `count` digits of n, with leading zeros.
void write_digits(char* out, std::uint64_t n, int count) {
    for (int i = count - 1; i >= 0; --i) {
        out[i] = static_cast<char>('0' + n % 10);
        n /= 10;
    }
}

/// Writes the decimal fraction 0.000nnn or nn.nnn; requires 1e-7 <= value < 10^digits, digits <= 12.
/// One rounding of a product with an exact power of ten: as good as exact, and many times faster than the
/// general conversion.
char* write_fixed(char* out, double value, int digits) {
    int exponent = decimal_exponent(value);
    const int shift = digits - 1 - exponent;
    auto n = static_cast<std::uint64_t>(std::llround(value * power_of_ten[static_cast<std::size_t>(shift)]));
    int decimals = shift;
    while (decimals > 0 && n % 10 == 0) {
        n /= 10;
        --decimals;
    }
    const auto point = static_cast<std::uint64_t>(power_of_ten[static_cast<std::size_t>(decimals)]);
    out = std::to_chars(out, out + longest_number, n / point).ptr;
    if (decimals == 0) return out;
    *out++ = '.';
    write_digits(out, n % point, decimals);
    return out + decimals;
}

} // namespace

SdlWriter::SdlWriter(const TextSink& sink)
    : sink_(sink), buffer_(std::make_unique_for_overwrite<char[]>(capacity)) {}

char* SdlWriter::room(std::size_t bytes) {
    if (used_ + bytes > capacity) flush();
    return buffer_.get() + used_;
}

bool SdlWriter::flush() {
    if (!stopped_ && used_ > 0) stopped_ = !sink_(std::string_view(buffer_.get(), used_));
    used_ = 0;
    return !stopped_;
}

SdlWriter& SdlWriter::operator<<(std::string_view text) {
    while (!text.empty()) {
        const std::string_view piece = text.substr(0, capacity);
        std::memcpy(room(piece.size()), piece.data(), piece.size());
        used_ += piece.size();
        text.remove_prefix(piece.size());
    }
    return *this;
}

SdlWriter& SdlWriter::operator<<(std::uint64_t number) {
    char* const begin = room(longest_number);
    used_ += static_cast<std::size_t>(std::to_chars(begin, begin + longest_number, number).ptr - begin);
    return *this;
}

SdlWriter& SdlWriter::number(double value, int digits) {
    GRAFTAL_CHECK(std::isfinite(value), "emit_povray: a number is not finite");
    char* const begin = room(longest_number);
    char* out = begin;
    if (value < 0) *out++ = '-';
    const double size = std::abs(value);
    if (size == 0)
        *out++ = '0';
    else if (size >= 1e-7 && size < power_of_ten[static_cast<std::size_t>(digits)])
        out = write_fixed(out, size, digits);
    else
        out = std::to_chars(out, begin + longest_number, size, std::chars_format::general, digits).ptr;
    used_ += static_cast<std::size_t>(out - begin);
    return *this;
}

SdlWriter& SdlWriter::vector(Vec3 v, int digits) {
    *this << "<";
    number(v.x, digits) << ",";
    number(v.y, digits) << ",";
    return number(v.z, digits) << ">";
}

SdlWriter& SdlWriter::matrix(const Affine& a) {
    double largest = 0;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            largest = std::max(largest, std::abs(a.linear[column][row]));
    const double noise = noise_share * largest;
    *this << "matrix <";
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row) {
            const double entry = a.linear[column][row];
            number(std::abs(entry) <= noise ? 0 : entry, placement_digits) << ",";
        }
    number(a.translation.x, placement_digits) << ",";
    number(a.translation.y, placement_digits) << ",";
    return number(a.translation.z, placement_digits) << ">";
}

} // namespace graftal
