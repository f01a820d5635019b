#include "compiler/editing/complete.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/unit/editing/marked.h"

namespace graftal {
namespace {

using ::graftal::testing::marked;

/// The labels that are offered at the '^', or at another mark, with blanks between them.
std::string offered(const std::string& name, const std::string& text, char mark = '^') {
    const auto [document, offset] = marked(name, text, mark);
    std::string labels;
    for (const Completion& item : complete(document, offset).items)
        labels += (labels.empty() ? "" : " ") + item.label;
    return labels;
}

TEST(Complete, KeywordsOfTheBlockAround) {
    EXPECT_EQ(offered("m.rifs", "^"), "rifs main use orbit camera light background ground material steps let "
                                      "inner sky film haze preset");
    EXPECT_EQ(offered("m.rifs", "rifs a { co^ }"), "codes control condense");
    EXPECT_EQ(offered("m.rifs", "rifs a { map b { tra^ } }"), "translate");
    EXPECT_EQ(offered("m.rifs", "rifs a { map b { scale 1/2 t^ } }"), "translate tint terminal tan");
    EXPECT_EQ(offered("m.inst", "object a { cube sc^ }"), "scale scatter");
    EXPECT_EQ(offered("m.inst", "camera { lo^ }"), "location look_at");
    EXPECT_EQ(offered("m.inst", "camera { location: 1, 2, 3\n  o^ }"), "orthographic");
    EXPECT_EQ(offered("m.lsys", "lsys a {\n  axiom F\n  thi^\n}"), "thickness thinnest");
    EXPECT_EQ(offered("m.lsys", "ma^"), "main material");
}

TEST(Complete, NamesWhereTheyAreKnown) {
    EXPECT_EQ(offered("m.rifs", "let lean = 3\nrifs a { map b { rotate z, le^ } }"), "lean lerp");
    EXPECT_EQ(offered("m.rifs", "rifs a { map one {} map two {} follow o^ }"), "one");
    EXPECT_EQ(offered("m.rifs", "rifs a { map one {} map two {} follow one -> ^ }"), "one two");
    EXPECT_EQ(offered("m.rifs", "rifs other {} rifs a { map b from ^ {} }"), "other a");
    EXPECT_EQ(offered("m.inst", "canonical object leaf { cube }\nobject a { union: l^ }"), "leaf limb_sweep");
    EXPECT_EQ(offered("m.inst", "material blue { }\nobject a { cube material: b^ }"), "blue bark");
    EXPECT_EQ(offered("m.inst", "canonical object tip(size) { instance: cube scale: si^ }"), "size sin sign");
    EXPECT_EQ(
        offered("m.inst", "canonical object tip(size) { cube }\nobject b { instance: cube scale: siz^ }"),
        "");
    EXPECT_EQ(offered("m.lsys", "lsys a {\n  let grow = 2\n  axiom A\n  A(x) -> F(gr`)\n}", '`'), "grow");
    EXPECT_EQ(offered("m.lsys", "lsys a {\n  axiom A\n  A(xx) : x` -> F\n}", '`'), "xx");
}

TEST(Complete, SymbolsOfStrings) {
    EXPECT_EQ(offered("m.lsys", "lsys a {\n  modules Bud Leaf\n  axiom FB`\n}", '`'), "Bud");
    EXPECT_EQ(offered("m.lsys", "lsys a {\n  axiom F@G`\n}", '`'), "@Gs @Gc @Ge");
    EXPECT_EQ(offered("m.lsys", "use leaf = \"l.rifs\"\nlsys a {\n  axiom F~le`\n}", '`'), "leaf");
    EXPECT_EQ(offered("m.lsys", "lsys a {\n  environment sh`\n}", '`'), "shade shadows");
}

TEST(Complete, BracketsAndColonsOfCommentsDoNotCount) {
    EXPECT_EQ(offered("m.lsys", "lsys a {\n  axiom F[ # one ( two\n    F@G`]\n}", '`'), "@Gs @Gc @Ge");
    EXPECT_EQ(offered("m.lsys", "lsys a {\n  axiom F(1 /* ) */)F//(2)@G`\n}", '`'), "@Gs @Gc @Ge");
    EXPECT_EQ(offered("m.lsys", "lsys a {\n  let grow = 2\n  axiom F(1 /* ) */ + gr`)\n}", '`'), "grow");
}

TEST(Complete, NothingInCommentsAndQuotes) {
    EXPECT_EQ(offered("m.rifs", "rifs a { # co^\n }"), "");
    EXPECT_EQ(offered("m.rifs", "rifs a { // co^\n }"), "");
    EXPECT_EQ(offered("m.rifs", "use a = \"co^\""), "");
    EXPECT_EQ(offered("m.txt", "rifs ^"), "");
    EXPECT_EQ(offered("m.inst", "let ^"), "");
}

TEST(Complete, TellsWhatAWordMeans) {
    const auto [document, offset] = marked("m.rifs", "rifs a { map b { shea^ } }");
    const Completions completions = complete(document, offset);
    ASSERT_EQ(completions.items.size(), 1u);
    EXPECT_EQ(completions.from, offset - 4);
    EXPECT_EQ(completions.items[0].kind, "keyword");
    EXPECT_EQ(completions.items[0].detail, "shear: xy, 0.5  Adds 0.5 y to x; any two different axes.");
}

} // namespace
} // namespace graftal
