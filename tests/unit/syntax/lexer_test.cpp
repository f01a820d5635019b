#include "compiler/syntax/lexer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace graftal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

struct Lexed {
    SourceMap sources;
    Diagnostics diagnostics;
    std::vector<Token> tokens;

    explicit Lexed(std::string text) {
        tokens = lex(sources, sources.add("t.inst", std::move(text)), diagnostics);
    }
    std::vector<std::string> texts() const {
        std::vector<std::string> out;
        for (const Token& token : tokens)
            if (token.kind != TokenKind::end) out.emplace_back(token.text);
        return out;
    }
    std::string errors() const { return diagnostics.render(sources); }
};

TEST(Lexer, splits_names_numbers_strings_and_symbols) {
    const Lexed lexed("leaf.llr: -.5,2e-3 -> a1_b<=\"x y\"&&");
    EXPECT_THAT(lexed.texts(),
                ElementsAre("leaf.llr", ":", "-", ".5", ",", "2e-3", "->", "a1_b", "<=", "x y", "&&"));
    EXPECT_EQ(lexed.errors(), "");
    EXPECT_EQ(lexed.tokens[3].number, 0.5);
    EXPECT_EQ(lexed.tokens[5].number, 0.002);
    EXPECT_EQ(lexed.tokens[9].kind, TokenKind::string);
}

TEST(Lexer, a_number_may_be_followed_by_a_word) {
    EXPECT_THAT(Lexed("codes 2d { 1e 1.x }").texts(),
                ElementsAre("codes", "2", "d", "{", "1", "e", "1.", "x", "}"));
}

TEST(Lexer, two_dots_are_a_range_and_no_part_of_its_ends) {
    EXPECT_THAT(
        Lexed("0..360 .5...7 1. .. a..b 2.5..3").texts(),
        ElementsAre("0", "..", "360", ".5", "..", ".7", "1.", "..", "a", "..", "b", "2.5", "..", "3"));
}

TEST(Lexer, knows_line_starts_and_space_before_tokens) {
    const Lexed lexed("a -1 # c\n - 1 /* \n */ b// x\nc");
    std::vector<bool> first, space;
    for (const Token& token : lexed.tokens) {
        first.push_back(token.first_on_line);
        space.push_back(token.space_before);
    }
    EXPECT_THAT(first, ElementsAre(true, false, false, true, false, true, true, false));
    EXPECT_THAT(space, ElementsAre(true, true, false, true, true, true, true, false));
}

TEST(Lexer, numbers_keep_every_bit) {
    const Lexed lexed("0.1 1.7976931348623157e308 5e-324 4.9406564584124654e-324 0.30000000000000004");
    EXPECT_EQ(lexed.errors(), "");
    EXPECT_EQ(lexed.tokens[0].number, 0.1);
    EXPECT_EQ(lexed.tokens[1].number, 1.7976931348623157e308);
    EXPECT_EQ(lexed.tokens[2].number, 5e-324);
    EXPECT_EQ(lexed.tokens[3].number, 5e-324);
    EXPECT_EQ(lexed.tokens[4].number, 0.1 + 0.2);
}

TEST(Lexer, tiny_numbers_are_zero_and_huge_ones_errors) {
    const std::string zeros(400, '0');
    const Lexed tiny("1e-400 0." + zeros + "1");
    EXPECT_EQ(tiny.errors(), "");
    EXPECT_EQ(tiny.tokens[0].number, 0);
    EXPECT_EQ(tiny.tokens[1].number, 0);
    EXPECT_THAT(Lexed("1e400").errors(), HasSubstr("t.inst:1:1: error: this number is too large"));
    EXPECT_THAT(Lexed("1" + zeros + ".5").errors(), HasSubstr("too large"));
}

TEST(Lexer, goes_on_after_each_error) {
    const Lexed lexed("a $$$ b \x01 \"open\nc \xC3\xA9 d");
    EXPECT_THAT(lexed.texts(), ElementsAre("a", "b", "open", "c", "\xC3\xA9", "d"));
    EXPECT_EQ(lexed.errors(), "t.inst:1:3: error: unexpected character '$'\n"
                              "    a $$$ b ? \"open\n"
                              "      ^\n"
                              "t.inst:1:9: error: unexpected byte 0x01\n"
                              "    a $$$ b ? \"open\n"
                              "            ^\n"
                              "t.inst:1:11: error: this string is not closed on its line\n"
                              "    a $$$ b ? \"open\n"
                              "              ^~~~~\n"
                              "    hint: close it with '\"'\n"
                              "t.inst:2:3: error: unexpected character '\xC3\xA9'\n"
                              "    c \xC3\xA9 d\n"
                              "      ^\n"
                              "    hint: write names with the letters a to z and A to Z, digits and _\n");
}

TEST(Lexer, reads_lookalikes_as_what_they_were_meant_as_and_reports_each_once) {
    const Lexed lexed(
        "use a = \u201Cb.inst\u201D 'c' \uFF5B \uFF13, \u22122 \u2192 \u00D7 x\u00A0y\u00A0z\u00A0 \uFF5D");
    EXPECT_THAT(lexed.texts(), ElementsAre("use", "a", "=", "b.inst", "c", "{", "\uFF13", ",", "-", "2", "->",
                                           "*", "x", "y", "z", "}"));
    EXPECT_EQ(lexed.tokens[3].kind, TokenKind::string);
    EXPECT_EQ(lexed.tokens[6].number, 3);
    EXPECT_EQ(lexed.diagnostics.error_count(), 9u) << lexed.errors();
    EXPECT_THAT(lexed.errors(), HasSubstr("unexpected character U+00A0"));
    EXPECT_THAT(lexed.errors(), HasSubstr("hint: it is a no-break space; write a space"));
    EXPECT_THAT(Lexed("color: #ff8000").texts(), ElementsAre("color", ":", "#ff8000", "#ff8000", "#ff8000"));
    EXPECT_EQ(Lexed("color: #ff8000").tokens[3].number, 0.216) << "linear";
    EXPECT_THAT(Lexed("color: #ffx\nscale #fff").texts(), ElementsAre("color", ":", "scale")) << "comments";
    EXPECT_THAT(Lexed("\xFF\xFEo\0").errors(), HasSubstr("this text is in UTF-16"));
}

TEST(Lexer, an_open_comment_ends_the_file) {
    const Lexed lexed("a /* b\nc");
    EXPECT_THAT(lexed.texts(), ElementsAre("a"));
    EXPECT_THAT(lexed.errors(), HasSubstr("t.inst:1:3: error: this comment is not closed"));
}

TEST(Lexer, survives_every_byte) {
    std::string text;
    for (int i = 0; i < 256; ++i)
        text += static_cast<char>(i);
    const Lexed lexed(text + text);
    EXPECT_GT(lexed.diagnostics.error_count(), 0u);
    EXPECT_EQ(lexed.tokens.back().kind, TokenKind::end);
    EXPECT_EQ(Lexed("").tokens.size(), 1u);
    EXPECT_THAT(Lexed("\xEF\xBB\xBF"
                      "a")
                    .texts(),
                ElementsAre("a"));
}

TEST(Lexer, the_end_lies_just_after_the_last_token) {
    const Lexed lexed("a b\n\n  # c\n");
    EXPECT_EQ(lexed.tokens.back().span.begin, 3u);
}

} // namespace
} // namespace graftal
