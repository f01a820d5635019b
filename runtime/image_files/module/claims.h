#pragma once

#include <cstdint>
#include <string>

namespace graftal {

/// Larger pictures must come row by row, or in bands of less than this, out of their file.
constexpr std::uint64_t most_held_samples = 1u << 26;

/// Why the head of a GIF or an EXR is not to be believed: it asks for more memory than the picture can need,
/// and their readers make room before they look whether the file holds as much. "" for other formats, and for
/// what cannot be read.
std::string false_claim(const std::string& path);

} // namespace graftal
