#include "compiler/editing/hover.h"

#include <gtest/gtest.h>

#include "compiler/session/session.h"
#include "tests/unit/editing/marked.h"

namespace graftal {
namespace {

using ::graftal::testing::marked;

std::string hovered(const std::string& name, const std::string& text, char mark = '^') {
    const auto [document, offset] = marked(name, text, mark);
    const std::optional<Hover> found = hover(document, offset);
    return found ? std::string(document.text(found->span)) + ": " + found->text : "";
}

TEST(Hover, WordsOfTheLanguages) {
    EXPECT_EQ(
        hovered("m.rifs", "rifs a { map b { sc^ale 1/2 } }"),
        "scale: `scale: s | x, y | x, y, z`\n\nOne factor for all axes, or one an axis; of two, z gets the "
        "geometric mean.");
    EXPECT_EQ(hovered("m.inst", "object a { ^cube }"), "cube: `cube`\n\n[-1, 1] in each axis");
    EXPECT_EQ(hovered("m.lsys", "lsys a {\n  axiom F`@Gs\n}", '`'),
              "@Gs: `@Gs`\n\nbegin, continue and end a generalised cylinder");
    EXPECT_EQ(
        hovered("m.lsys", "lsys a {\n  axiom `+F\n}", '`'),
        "+: `+(a)`\n\nturns left by a degrees (default `angle`): the heading towards the left, about z");
    EXPECT_EQ(hovered("m.rifs", "rifs a { # sca^le\n }"), "");
    EXPECT_EQ(hovered("m.rifs", "rifs a { map b { scale 1^2 } }"), "");
}

TEST(Hover, NamesOfTheText) {
    EXPECT_EQ(hovered("m.rifs", "let lean = 3\nrifs a { map b { rotate z, le^an } }"),
              "lean: **let** `lean`\n\n```rifs\nlean = 3\n```");
    EXPECT_EQ(hovered("m.lsys", "lsys a {\n  axiom A\n  A -> `F\n  F -> FF\n}", '`'),
              "F: **module** `F`\n\n```lsys\nF -> FF\n```\n\n`F(l)`\n\nmoves ahead by l (default `step`) and "
              "draws a "
              "segment");
    EXPECT_EQ(hovered("m.inst", "object a { cube material: go^ld }"),
              "gold: **material** `gold`\n\nA material that every model knows.");
}

TEST(Hover, CommentsAreNoMarkdown) {
    const std::string map = "map b { scale 1/2 # ```` ![a](https://b/c)\n }";
    const std::string text = "rifs a { " + map + " }";
    const auto found = hover(Document("m.rifs", text), static_cast<std::uint32_t>(text.find("b {")));
    ASSERT_TRUE(found);
    EXPECT_EQ(found->text, "**map** `b`\n\n`````rifs\n" + map + "\n`````");
}

TEST(Hover, SizesOfObjects) {
    const std::string text = "canonical object half { instance: cube scale: 1/2 }\n"
                             "object a { instance: half instance: half translate: 2, 0, 0 }";
    Session session("m.inst", text);
    Compilation compilation;
    const auto model = session.analysed({}, compilation);
    ASSERT_TRUE(model);
    const Document document("m.inst", text);
    const auto at = static_cast<std::uint32_t>(text.find("a {"));
    const std::optional<Hover> found = hover(document, at, model.get());
    ASSERT_TRUE(found);
    EXPECT_EQ(found->text,
              "**object** `a`\n\n```inst\nobject a { instance: half instance: half translate: 2, 0, 0 }"
              "\n```\n\nBox from (-0.5, -0.5, -0.5) to (2.5, 0.5, 0.5). 2 primitives.");
}

/// The file and the place of a definition, as "m.rifs:4".
std::string defined(const std::string& name, const std::string& text, char mark = '^') {
    const auto [document, offset] = marked(name, text, mark);
    const std::optional<FilePlace> found = definition(document, offset);
    return found ? found->file + ":" + std::to_string(found->span.begin) : "";
}

TEST(Definition, NamesAndFiles) {
    EXPECT_EQ(defined("m.rifs", "let a = 1, b = a\nrifs c { map d { scale ^a } }"), "m.rifs:4");
    EXPECT_EQ(defined("d/m.rifs", "use leaf = \"le^af.inst\""), "d/leaf.inst:0");
    EXPECT_EQ(defined("m.rifs", "use leaf = \"leaf.inst\"\nrifs c { map d { scale 1/2 } condense le^af }"),
              "m.rifs:4");
    EXPECT_EQ(defined("m.lsys", "lsys a {\n  axiom B`\n  B -> F\n}", '`'), "m.lsys:21");
    // The parameter of an object hides a let.
    EXPECT_EQ(
        defined("m.inst", "let n = 1\nobject a { b(1) }\ncanonical object b(n) { instance: cube scale: ^n }"),
        "m.inst:47");
    // A row without a label is known by its number.
    EXPECT_EQ(
        defined("m.rifs", "rifs a { codes 2d {\n .5 0 0 .5 0 0\n .5 0 0 .5 1 0\n }\n follow w^2 -> w1 }"),
        "m.rifs:36");
    EXPECT_EQ(defined("m.rifs", "rifs a { map b { ^scale 1/2 } }"), "");
}

} // namespace
} // namespace graftal
