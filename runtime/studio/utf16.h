#pragma once

#include <cstddef>
#include <string_view>

namespace graftal {

/// Units of UTF-16 that the first `bytes` bytes of a text take; a byte that is not UTF-8 counts as one unit.
std::size_t utf16_offset(std::string_view text, std::size_t bytes);

/// The inverse: bytes before a unit of UTF-16; the text's size for what lies beyond it.
std::size_t byte_offset(std::string_view text, std::size_t units);

} // namespace graftal
