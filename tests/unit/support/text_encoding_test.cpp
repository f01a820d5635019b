#include "compiler/support/text_encoding.h"

#include <gtest/gtest.h>

namespace graftal {
namespace {

std::string kept(const std::string& bytes) {
    return decoded_text(bytes, OtherBytes::kept);
}
std::string windows(const std::string& bytes) {
    return decoded_text(bytes, OtherBytes::windows_1252);
}

TEST(TextEncoding, AByteOrderMarkChooses) {
    EXPECT_EQ(kept("\xEF\xBB\xBF"
                   "a\xC3\xA9"),
              "a\xC3\xA9");
    EXPECT_EQ(kept(std::string("\xFF\xFE"
                               "a\0\x12\x22\x3D\xD8\x00\xDE",
                               10)),
              "a\xE2\x88\x92\xF0\x9F\x98\x80");
    EXPECT_EQ(kept(std::string("\xFE\xFF\0a\x22\x12", 6)), "a\xE2\x88\x92");
    EXPECT_EQ(kept(std::string("\xFE\xFF\xD8\x3D\0", 5)), "\xEF\xBF\xBD\xEF\xBF\xBD") << "halves";
}

TEST(TextEncoding, OtherBytesAreThoseOfWindows) {
    EXPECT_EQ(windows("\x96\xE9\x93"), "\xE2\x80\x93\xC3\xA9\xE2\x80\x9C");
    EXPECT_EQ(windows("\xC3\xA9"), "\xC3\xA9");
    EXPECT_EQ(kept("\x96"), "\x96");
}

TEST(TextEncoding, LinesEndAlike) {
    EXPECT_EQ(kept("a\r\nb\rc\n\rd\r"), "a\nb\nc\n\nd\n");
    EXPECT_EQ(kept("a\r\n\x1a"), "a\n");
    EXPECT_EQ(kept(kept("\xEF\xBB\xBF\r\r\n")), kept("\xEF\xBB\xBF\r\r\n"));
}

} // namespace
} // namespace graftal
