#pragma once

#include <string>
#include <string_view>

namespace graftal {

/// The bytes in zlib's format (RFC 1950) without compression.
std::string stored(std::string_view bytes);

} // namespace graftal
