#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace graftal {

/// A place as the Language Server Protocol counts: lines from 0, and UTF-16 units in the line from 0.
struct LinePosition {
    std::uint32_t line = 0;
    std::uint32_t character = 0;

    bool operator==(const LinePosition&) const = default;
};

/// Turns bytes of a text into UTF-16 offsets and line positions, and back. Bytes that are no UTF-8 count as
/// one unit each. A place inside of a character is taken for its beginning, one past the end for the end.
class TextPositions {
  public:
    /// `text` must outlive it. O(text).
    explicit TextPositions(std::string_view text);

    /// O(log lines + length of the line).
    std::uint32_t utf16_of(std::uint32_t byte) const;
    std::uint32_t byte_of(std::uint32_t utf16) const;
    LinePosition line_position(std::uint32_t byte) const;
    /// A character past the end of its line is taken for that end.
    std::uint32_t byte_of(LinePosition position) const;

  private:
    struct Line {
        std::uint32_t byte = 0; ///< where it begins
        std::uint32_t utf16 = 0;
    };
    const Line& line_at(std::uint32_t byte) const;

    std::string_view text_;
    std::vector<Line> lines_;
};

} // namespace graftal
