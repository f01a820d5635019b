#include "compiler/support/diagnostics.h"

#include <algorithm>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace graftal {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

/// Renders one error on [begin, end) of a text.
std::string rendered(const std::string& text, std::uint32_t begin, std::uint32_t end,
                     const std::string& message = "message") {
    SourceMap sources;
    const FileId file = sources.add("m.inst", text);
    Diagnostics diagnostics;
    diagnostics.error({file, begin, end}, message);
    return diagnostics.render(sources);
}

bool is_utf8(std::string_view text) {
    for (std::size_t i = 0; i < text.size();) {
        const auto lead = static_cast<unsigned char>(text[i]);
        const std::size_t length = lead < 0x80       ? 1
                                   : lead >> 5 == 6  ? 2
                                   : lead >> 4 == 14 ? 3
                                   : lead >> 3 == 30 ? 4
                                                     : 0;
        if (length == 0 || i + length > text.size()) return false;
        for (std::size_t k = 1; k < length; ++k)
            if ((text[i + k] & 0xC0) != 0x80) return false;
        i += length;
    }
    return true;
}

TEST(Diagnostics, ErrorWithLineAndCaret) {
    EXPECT_EQ(rendered("object a {\n  union: upp\n}\n", 20, 23, "no object is named 'upp'"),
              "m.inst:2:10: error: no object is named 'upp'\n"
              "      union: upp\n"
              "             ^~~\n");
}

TEST(Diagnostics, NotesAreNoErrorsAndQuietLeavesThemOut) {
    Diagnostics diagnostics;
    diagnostics.warning({}, "this is strange");
    diagnostics.note({}, "this could be better").with_hint("like this");
    EXPECT_FALSE(diagnostics.has_errors());
    EXPECT_EQ(diagnostics.render(SourceMap()), "graftal: warning: this is strange\n"
                                               "graftal: note: this could be better\n"
                                               "    hint: like this\n");
    EXPECT_EQ(diagnostics.render(SourceMap(), true), "graftal: warning: this is strange\n");
}

TEST(Diagnostics, HintsAndNotesFollowTheirDiagnostic) {
    SourceMap sources;
    const FileId file = sources.add("m.inst", "a {}\nb {}\na {}\n");
    const FileId other = sources.add("used.inst", "x\n");
    Diagnostics diagnostics;
    diagnostics.error({file, 10, 11}, "'a' is defined twice")
        .with_hint("rename one")
        .with_note({file, 0, 1}, "first defined here")
        .with_note({other, 0, 1}, "used here")
        .with_note({}, "a note without a place");
    diagnostics.warning({file, 5, 6}, "'b' is never used");
    EXPECT_EQ(diagnostics.render(sources), "m.inst:3:1: error: 'a' is defined twice\n"
                                           "    a {}\n"
                                           "    ^\n"
                                           "    hint: rename one\n"
                                           "m.inst:1:1: note: first defined here\n"
                                           "    a {}\n"
                                           "    ^\n"
                                           "used.inst:1:1: note: used here\n"
                                           "    x\n"
                                           "    ^\n"
                                           "graftal: note: a note without a place\n"
                                           "m.inst:2:1: warning: 'b' is never used\n"
                                           "    b {}\n"
                                           "    ^\n");
    EXPECT_EQ(diagnostics.error_count(), 1u);
    EXPECT_EQ(diagnostics.all().size(), 2u);
}

TEST(Diagnostics, WithoutAPlaceTheProgramSpeaks) {
    Diagnostics diagnostics;
    diagnostics.error({}, "nothing to draw").with_hint("add an object");
    EXPECT_EQ(diagnostics.render(SourceMap()), "graftal: error: nothing to draw\n    hint: add an object\n");
}

TEST(Diagnostics, WarningsAreNoErrors) {
    Diagnostics diagnostics;
    diagnostics.warning({}, "odd");
    EXPECT_FALSE(diagnostics.has_errors());
    diagnostics.error({}, "wrong");
    EXPECT_TRUE(diagnostics.has_errors());
}

TEST(Diagnostics, CaretStandsUnderTheCharacterWhateverItsBytes) {
    EXPECT_EQ(rendered("\u00E9\u20AC\U0001F33F bad", 10, 13), "m.inst:1:5: error: message\n"
                                                              "    \u00E9\u20AC\U0001F33F bad\n"
                                                              "        ^~~\n");
    EXPECT_EQ(rendered("a\u00E9\u00E9b", 1, 5), "m.inst:1:2: error: message\n"
                                                "    a\u00E9\u00E9b\n"
                                                "     ^~\n");
}

TEST(Diagnostics, TabsAndControlCharactersCannotMoveTheCaret) {
    EXPECT_EQ(rendered("\tx\t\x1B[31my", 2, 2 + 6), "m.inst:1:3: error: message\n"
                                                    "     x ?[31my\n"
                                                    "      ^~~~~~\n");
}

TEST(Diagnostics, ASpanOfManyLinesIsMarkedToTheEndOfTheFirst) {
    EXPECT_EQ(rendered("object a {\n  union: b\n}\n", 7, 23), "m.inst:1:8: error: message\n"
                                                              "    object a {\n"
                                                              "           ^~~\n");
}

TEST(Diagnostics, EmptySpansAndEndsOfFilesHaveOneCaret) {
    EXPECT_EQ(rendered("ab", 1, 1), "m.inst:1:2: error: message\n    ab\n     ^\n");
    EXPECT_EQ(rendered("ab", 2, 2), "m.inst:1:3: error: message\n    ab\n      ^\n");
    EXPECT_EQ(rendered("ab\n", 3, 3), "m.inst:2:1: error: message\n    \n    ^\n");
    EXPECT_EQ(rendered("ab\r\n", 3, 4), "m.inst:1:4: error: message\n    ab\n      ^\n");
    EXPECT_EQ(rendered("", 0, 0), "m.inst:1:1: error: message\n    \n    ^\n");
}

TEST(Diagnostics, AVeryLongLineIsShownAsAWindowAroundTheCaret) {
    const std::string text = std::string(100'000, 'x') + "BAD" + std::string(100'000, 'y');
    const std::string out = rendered(text, 100'000, 100'003);
    EXPECT_EQ(out, "m.inst:1:100001: error: message\n"
                   "    " +
                       std::string(80, 'x') + "BAD" + std::string(77, 'y') + "\n" + "    " +
                       std::string(80, ' ') + "^~~\n");
}

TEST(Diagnostics, ASpanLongerThanTheWindowEndsWithIt) {
    const std::string out = rendered(std::string(1000, 'x'), 0, 1000);
    EXPECT_THAT(out, EndsWith("\n    " + std::string(160, 'x') + "\n    ^" + std::string(159, '~') + "\n"));
}

TEST(Diagnostics, TheWindowNeverCutsACharacterInHalf) {
    for (std::size_t shift = 0; shift < 3; ++shift) {
        std::string text(shift, 'a');
        for (int i = 0; i < 200; ++i)
            text += "\u20AC";
        const std::uint32_t at = static_cast<std::uint32_t>(shift + 3 * 100);
        const std::string out = rendered(text, at, at + 3);
        EXPECT_TRUE(is_utf8(out)) << out;
        EXPECT_THAT(out, EndsWith("^\n"));
    }
}

TEST(Diagnostics, ErrorsPastTheLimitAreCountedNotKept) {
    Diagnostics diagnostics;
    for (int i = 0; i < 100'000; ++i)
        diagnostics.error({}, "e" + std::to_string(i)).with_hint("kept or not, this must work");
    EXPECT_EQ(diagnostics.all().size(), Diagnostics::max_errors);
    EXPECT_EQ(diagnostics.error_count(), 100'000u);
    EXPECT_TRUE(diagnostics.full());
    const std::string out = diagnostics.render(SourceMap());
    EXPECT_THAT(out, StartsWith("graftal: error: e0\n"));
    EXPECT_THAT(out, EndsWith("graftal: 99900 more errors\n"));
}

TEST(Diagnostics, AFloodOfWarningsHidesNoError) {
    Diagnostics diagnostics;
    for (int i = 0; i < 1000; ++i)
        diagnostics.warning({}, "w");
    diagnostics.error({}, "the one that matters");
    EXPECT_THAT(diagnostics.render(SourceMap()), HasSubstr("error: the one that matters\n"));
    EXPECT_LE(diagnostics.all().size(), Diagnostics::max_errors + 1);
}

TEST(Diagnostics, WhatIsEchoedIsShortAndGivesTheTerminalNoOrders) {
    Diagnostics diagnostics;
    diagnostics.error({}, "escape \x1b[31m, line\nend, C1 \u009b31m, turned \u202e, byte \xff, tab\t.")
        .with_hint("hidden \u200b")
        .with_note({}, "bell \a");
    diagnostics.error({}, "cannot open '" + std::string(50'000'000, 'x') + "': No such file or directory");
    const std::string out = diagnostics.render(SourceMap());
    EXPECT_THAT(
        out, HasSubstr("escape \\x1b[31m, line\\nend, C1 \\u009b31m, turned \\u202e, byte \\xff, tab .\n"));
    EXPECT_THAT(out, HasSubstr("hint: hidden \\u200b\n"));
    EXPECT_THAT(out, HasSubstr("note: bell \\x07\n"));
    EXPECT_THAT(out, HasSubstr("xxx...xxx"));
    EXPECT_THAT(out, EndsWith("xxx': No such file or directory\n"));
    EXPECT_LT(out.size(), 1500u);

    SourceMap sources;
    const FileId file = sources.add("a\x1b]0;b", "x \x1b[2J \u202e \u009b y");
    Diagnostics at_text;
    at_text.error({file, 13, 14}, "here");
    EXPECT_EQ(at_text.render(sources), "a\\x1b]0;b:1:11: error: here\n"
                                       "    x ?[2J ? ? y\n"
                                       "              ^\n");
}

TEST(Choices, NameTheNearestAndAllWhereTheyAreFew) {
    EXPECT_EQ(choices("colour", {"color", "ambient"}), "did you mean 'color'? known here: color, ambient");
    EXPECT_EQ(choices("fov", {"angle", "up"}), "known here: angle, up");
    EXPECT_EQ(choices("fov", {}), "");
    EXPECT_EQ(choices("scael", {"scale", "scale"}), "did you mean 'scale'? known here: scale");
    std::vector<std::string> many = {"scale"};
    for (int i = 0; i < 100; ++i)
        many.push_back("another" + std::to_string(i));
    EXPECT_EQ(choices("scael", many), "did you mean 'scale'?");
    EXPECT_EQ(closest_name("Lsystem", {"rifs", "lsys"}), "lsys") << "begins so, in other letters";
    EXPECT_EQ(closest_name("prob", {"tint", "probability"}), "probability");
    EXPECT_EQ(closest_name("PI", {"e", "pi"}), "pi");
    EXPECT_EQ(closest_name("b", {"by", "a"}), "") << "any letter is as near";
}

TEST(ClosestName, FindsWhatWasMeant) {
    const std::vector<std::string> names = {"scale", "rotate", "translate", "tint"};
    EXPECT_EQ(closest_name("scael", names), "scale") << "a transposition";
    EXPECT_EQ(closest_name("sclae", names), "scale");
    EXPECT_EQ(closest_name("rotat", names), "rotate") << "a letter left out";
    EXPECT_EQ(closest_name("transslate", names), "translate") << "a letter too many";
    EXPECT_EQ(did_you_mean("tnit", names), "did you mean 'tint'?");
}

TEST(ClosestName, StaysSilentRatherThanGuess) {
    const std::vector<std::string> names = {"scale", "up", "a"};
    EXPECT_EQ(closest_name("rotate", names), "");
    EXPECT_EQ(closest_name("x", names), "") << "one letter, wrong";
    EXPECT_EQ(closest_name("scale", {}), "");
    EXPECT_EQ(closest_name("", names), "");
    EXPECT_EQ(did_you_mean("rotate", names), "");
}

TEST(ClosestName, TakesTheFirstOfEquals) {
    EXPECT_EQ(closest_name("llx", {"llr", "llf"}), "llr");
    EXPECT_EQ(closest_name("llx", {"llf", "llr"}), "llf");
}

TEST(ClosestName, HugeNamesCostNothing) {
    const std::string huge(1 << 20, 'x');
    EXPECT_EQ(closest_name(huge, {huge + "y"}), "");
    EXPECT_EQ(closest_name("x", {huge}), "");
}

} // namespace
} // namespace graftal
