#include "compiler/povray/sdl_writer.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <glm/common.hpp>

#include "compiler/support/check.h"
#include "compiler/support/decimal_text.h"

namespace graftal {

namespace {

constexpr int placement_digits = 9;
constexpr double noise_share = 1e-13;
constexpr std::size_t longest_number = 40;
constexpr std::size_t longest_vector = 3 * longest_number + 4;

/// Writes the decimal fraction 0.000nnn or nn.nnn; requires 1e-7 <= value < 10^digits, digits <= 12.
/// One rounding of a product with an exact power of ten: as good as exact, and many times faster than the
/// general conversion.
char* write_fixed(char* out, double value, int digits) {
    const int shift = digits - 1 - decimal_exponent(value);
    return write_decimal(
        out, static_cast<std::uint64_t>(value * power_of_ten[static_cast<std::size_t>(shift)] + 0.5), shift);
}

char* write_number(char* out, double value, int digits) {
    GRAFTAL_CHECK(std::isfinite(value), "emit_povray: a number is not finite");
    if (value < 0) *out++ = '-';
    const double size = std::abs(value);
    if (size == 0) {
        *out = '0';
        return out + 1;
    }
    if (size >= 1e-7 && size < power_of_ten[static_cast<std::size_t>(digits)])
        return write_fixed(out, size, digits);
    return std::to_chars(out, out + longest_number, size, std::chars_format::general, digits).ptr;
}

char* write_vector(char* out, Vec3 v, int digits) {
    *out++ = '<';
    out = write_number(out, v.x, digits);
    *out++ = ',';
    out = write_number(out, v.y, digits);
    *out++ = ',';
    out = write_number(out, v.z, digits);
    *out++ = '>';
    return out;
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

SdlWriter& SdlWriter::written(const char* end) {
    used_ = static_cast<std::size_t>(end - buffer_.get());
    return *this;
}

SdlWriter& SdlWriter::in_pieces(std::string_view text) {
    while (!text.empty()) {
        const std::string_view piece = text.substr(0, capacity);
        std::memcpy(room(piece.size()), piece.data(), piece.size());
        used_ += piece.size();
        text.remove_prefix(piece.size());
    }
    return *this;
}

SdlWriter& SdlWriter::operator<<(std::uint64_t number) {
    return written(write_integer(room(longest_number), number));
}

SdlWriter& SdlWriter::number(double value, int digits) {
    return written(write_number(room(longest_number), value, digits));
}

SdlWriter& SdlWriter::indices(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    char* out = room(longest_vector);
    *out++ = '<';
    out = write_integer(out, a);
    *out++ = ',';
    out = write_integer(out, b);
    *out++ = ',';
    out = write_integer(out, c);
    *out++ = '>';
    return written(out);
}

SdlWriter& SdlWriter::vector(Vec3 v, int digits) {
    return written(write_vector(room(longest_vector), v, digits));
}

SdlWriter& SdlWriter::matrix(const Affine& a) {
    double largest = 0;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            largest = std::max(largest, std::abs(a.linear[column][row]));
    const double noise = noise_share * largest;
    *this << "matrix <";
    char* out = room(12 * (longest_number + 1));
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row) {
            const double entry = a.linear[column][row];
            out = write_number(out, std::abs(entry) <= noise ? 0 : entry, placement_digits);
            *out++ = ',';
        }
    for (int row = 0; row < 3; ++row) {
        out = write_number(out, a.translation[row], placement_digits);
        *out++ = row < 2 ? ',' : '>';
    }
    return written(out);
}

} // namespace graftal
