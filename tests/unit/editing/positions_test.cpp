#include "compiler/editing/positions.h"

#include <gtest/gtest.h>

namespace graftal {
namespace {

TEST(TextPositions, CountBytesUnitsAndLines) {
    const std::string text = "a\xC3\xA9\n\xF0\x9F\x8C\xB2z\xFF!\n"; // é, a tree beyond U+FFFF, no UTF-8
    const TextPositions positions(text);
    const std::uint32_t begins[] = {0, 1, 3, 4, 8, 9, 10, 11, 12};
    const std::uint32_t units[] = {0, 1, 2, 3, 5, 6, 7, 8, 9};
    for (std::size_t i = 0; i < std::size(begins); ++i) {
        EXPECT_EQ(positions.utf16_of(begins[i]), units[i]) << i;
        EXPECT_EQ(positions.byte_of(units[i]), begins[i]) << i;
    }
    EXPECT_EQ(positions.utf16_of(2), 1u); // inside of é
    EXPECT_EQ(positions.byte_of(4u), 4u); // between the halves of the tree
    EXPECT_EQ(positions.byte_of(99u), 12u);
    EXPECT_EQ(positions.line_position(8), (LinePosition{1, 2}));
    EXPECT_EQ(positions.line_position(12), (LinePosition{2, 0}));
    EXPECT_EQ(positions.byte_of(LinePosition{1, 3}), 9u);
    EXPECT_EQ(positions.byte_of(LinePosition{0, 99}), 3u); // the end of its line
    EXPECT_EQ(positions.byte_of(LinePosition{99, 0}), 12u);
}

} // namespace
} // namespace graftal
