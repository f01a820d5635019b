#pragma once

#include <cstdint>
#include <string>

namespace graftal {

/// The reading of bytes without a byte order mark where they are no UTF-8.
enum class OtherBytes : std::uint8_t { kept, windows_1252 };

/// The text of a file as UTF-8 whose lines end with '\n'. A byte order mark chooses UTF-8 or UTF-16, and is
/// left out; so is the mark 0x1A of DOS at the end. Reading the result again changes nothing.
std::string decoded_text(std::string bytes, OtherBytes others);

} // namespace graftal
