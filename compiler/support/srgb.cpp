#include "compiler/support/srgb.h"

#include <charconv>

namespace graftal {

std::optional<Rgb> srgb_from_hex(std::string_view digits) {
    if (digits.size() != 3 && digits.size() != 6) return std::nullopt;
    const std::size_t each = digits.size() / 3;
    Rgb encoded;
    for (std::size_t i = 0; i < 3; ++i) {
        unsigned value = 0;
        const char* const first = digits.data() + i * each;
        const auto [stop, error] = std::from_chars(first, first + each, value, 16);
        if (error != std::errc() || stop != first + each) return std::nullopt;
        encoded[static_cast<int>(i)] = value / (each == 1 ? 15.0 : 255.0);
    }
    return encoded;
}

} // namespace graftal
