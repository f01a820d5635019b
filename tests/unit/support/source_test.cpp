#include "compiler/support/source.h"
#include "tests/unit/broken_invariant.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace graftal {
namespace {

std::string position_text(const SourceMap& sources, FileId file, std::uint32_t offset) {
    const Position at = sources.position(file, offset);
    return std::to_string(at.line) + ":" + std::to_string(at.column);
}

TEST(Source, PositionsCountLinesAndColumnsFromOne) {
    SourceMap sources;
    const FileId file = sources.add("a.inst", "ab\ncd\n\ne");
    EXPECT_EQ(position_text(sources, file, 0), "1:1");
    EXPECT_EQ(position_text(sources, file, 1), "1:2");
    EXPECT_EQ(position_text(sources, file, 2), "1:3") << "a line end belongs to its line";
    EXPECT_EQ(position_text(sources, file, 3), "2:1");
    EXPECT_EQ(position_text(sources, file, 6), "3:1") << "an empty line";
    EXPECT_EQ(position_text(sources, file, 7), "4:1");
}

TEST(Source, ColumnsCountCodePointsNotBytes) {
    // One character each of one, two, three and four bytes.
    SourceMap sources;
    const FileId file = sources.add("a.inst", "x\u00E9\u20AC\U0001F33Fz");
    EXPECT_EQ(position_text(sources, file, 1), "1:2");
    EXPECT_EQ(position_text(sources, file, 3), "1:3");
    EXPECT_EQ(position_text(sources, file, 6), "1:4");
    EXPECT_EQ(position_text(sources, file, 10), "1:5");
}

TEST(Source, BytesThatAreNoUtf8StillHavePlaces) {
    SourceMap sources;
    const FileId file = sources.add("a.inst", "\xFF\xFE\x80\x80 x\n\xC3");
    EXPECT_EQ(position_text(sources, file, 5), "1:4") << "stray continuation bytes have no column";
    EXPECT_EQ(position_text(sources, file, 7), "2:1");
}

TEST(Source, PastTheEndIsJustAfterTheLastCharacter) {
    SourceMap sources;
    const FileId empty = sources.add("empty", "");
    const FileId open = sources.add("open", "ab");
    const FileId closed = sources.add("closed", "ab\n");
    EXPECT_EQ(position_text(sources, empty, 0), "1:1");
    EXPECT_EQ(position_text(sources, empty, 99), "1:1");
    EXPECT_EQ(position_text(sources, open, 99), "1:3");
    EXPECT_EQ(position_text(sources, closed, UINT32_MAX), "2:1");
}

TEST(Source, LinesComeWithoutTheirEnds) {
    SourceMap sources;
    const FileId file = sources.add("a.inst", "unix\ndos\r\n\nlast\r");
    EXPECT_EQ(sources.line(file, 1), "unix");
    EXPECT_EQ(sources.line(file, 2), "dos");
    EXPECT_EQ(sources.line(file, 3), "");
    EXPECT_EQ(sources.line(file, 4), "last");
}

TEST(Source, ViewsStayValidWhileFilesAreAdded) {
    SourceMap sources;
    const FileId first = sources.add("first", "s"); // short enough to lie inside the string object
    const std::string_view text = sources.text(first);
    const std::string_view name = sources.name(first);
    for (int i = 0; i < 1000; ++i)
        sources.add("more", "x");
    EXPECT_EQ(text, "s");
    EXPECT_EQ(name, "first");
    EXPECT_EQ(text.data(), sources.text(first).data());
    EXPECT_EQ(sources.size(), 1001u);
}

TEST(Source, TextOfASpan) {
    SourceMap sources;
    const FileId file = sources.add("a.inst", "union: up, llr");
    EXPECT_EQ(sources.text(Span{file, 7, 9}), "up");
    EXPECT_EQ(sources.text(Span{file, 7, 7}), "");
    EXPECT_EQ(sources.text(Span{}), "");
}

TEST(Source, JoinCoversBothInAnyOrder) {
    const Span a{0, 4, 6}, b{0, 10, 12};
    EXPECT_EQ(join(a, b), (Span{0, 4, 12}));
    EXPECT_EQ(join(b, a), (Span{0, 4, 12}));
    EXPECT_EQ(join(a, Span{}), a);
    EXPECT_EQ(join(Span{}, a), a);
    EXPECT_FALSE(join(Span{}, Span{}).known());
}

TEST(Source, JoinAcrossFilesIsABug) {
    EXPECT_BROKEN(join(Span{0, 0, 1}, Span{1, 0, 1}), "join of spans");
}

} // namespace
} // namespace graftal
