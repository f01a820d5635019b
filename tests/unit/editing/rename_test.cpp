#include "compiler/editing/rename.h"

#include <gtest/gtest.h>

#include "tests/unit/editing/marked.h"

namespace graftal {
namespace {

using ::graftal::testing::marked;

/// The text after the name at the mark became `to`, or "refused: why".
std::string renamed(const std::string& name, const std::string& text, const std::string& to,
                    char mark = '^') {
    const auto [document, offset] = marked(name, text, mark);
    const Renaming result = rename(document, offset, to);
    return result.refusal.empty() ? applied(document.text(), result.edits) : "refused: " + result.refusal;
}

TEST(Rename, Lets) {
    EXPECT_EQ(
        renamed("m.rifs", "let ^a = 1, b = a + (a)\nrifs c { map a { scale 1/a  rotate z, b } }", "turn"),
        "let turn = 1, b = turn + (turn)\nrifs c { map a { scale 1/turn  rotate z, b } }");
    EXPECT_EQ(renamed("m.lsys",
                      "let a = 1\nlsys s {\n  let a = a + 1\n  axiom F(a)A(a)\n  A(n) : n > a` with m = a -> "
                      "F(m)[A(n+a)] : a\n}",
                      "b", '`'),
              "let a = 1\nlsys s {\n  let b = a + 1\n  axiom F(b)A(b)\n  A(n) : n > b with m = b -> "
              "F(m)[A(n+b)] : b\n}");
}

TEST(Rename, ObjectsModelsMaterialsMapsBlocks) {
    EXPECT_EQ(renamed("m.inst",
                      "canonical object tip(0) { cube }\ncanonical object tip(n) { tip(n-1) }\n"
                      "object t { ^tip(3) }",
                      "end"),
              "canonical object end(0) { cube }\ncanonical object end(n) { end(n-1) }\nobject t { end(3) }");
    EXPECT_EQ(renamed("m.inst", "use ^leaf = \"l.inst\"\nobject t { leaf, leaf.blade }", "blatt"),
              "use blatt = \"l.inst\"\nobject t { blatt, blatt.blade }");
    EXPECT_EQ(
        renamed("m.inst",
                "material m { }\nmaterial n { from: m }\nground { material: m }\n"
                "object t { cube material: ^m }",
                "k"),
        "material k { }\nmaterial n { from: k }\nground { material: k }\nobject t { cube material: k }");
    EXPECT_EQ(renamed("m.rifs",
                      "rifs r { map a { scale 1/2 } map b { scale 1/3 } follow a -> b, ^a start b }", "x"),
              "rifs r { map x { scale 1/2 } map b { scale 1/3 } follow x -> b, x start b }");
    EXPECT_EQ(
        renamed("m.rifs", "rifs r { map a from ^s { scale 1/2 } }\nrifs s { map a { scale 1/2 } }", "t"),
        "rifs r { map a from t { scale 1/2 } }\nrifs t { map a { scale 1/2 } }");
}

TEST(Rename, ModulesWithTheirRules) {
    EXPECT_EQ(renamed("m.lsys", "lsys s {\n  axiom A\n  A -> F[+A]A`\n}", "B", '`'),
              "lsys s {\n  axiom B\n  B -> F[+B]B\n}");
    EXPECT_EQ(renamed("m.lsys", "lsys s {\n  axiom A\n  A -> F[+A]A`\n}", "Bud", '`'),
              "lsys s {\n  modules Bud\n  axiom Bud\n  Bud -> F[+Bud]Bud\n}");
    EXPECT_EQ(
        renamed("m.lsys", "lsys s {\n  modules Bud, Leaf\n  axiom `Bud\n  Bud -> F Bud Leaf\n}", "Twig", '`'),
        "lsys s {\n  modules Twig, Leaf\n  axiom Twig\n  Twig -> F Twig Leaf\n}");
}

TEST(Rename, RefusesWhatCollides) {
    EXPECT_EQ(renamed("m.rifs", "let ^a = 1, b = 2\nrifs c { map d { scale a/b/2 } }", "b"),
              "refused: 'b' already has a meaning where 'a' stands.");
    EXPECT_EQ(
        renamed("m.inst", "let ^a = 1\nobject t { c(2) }\ncanonical object c(n) { cube scale: a*n }", "n"),
        "refused: 'n' already has a meaning where 'a' stands.");
    EXPECT_EQ(renamed("m.inst", "object ^t { cube }", "sphere"), "refused: 'sphere' is a primitive.");
    EXPECT_EQ(renamed("m.inst", "object ^t { polygon(0,0,1,0,0,1) }", "polygon"),
              "refused: 'polygon' already has a meaning where 't' stands.");
    EXPECT_EQ(renamed("m.rifs", "let ^a = 1\nrifs c { map d { scale a/2 } }", "a b"),
              "refused: 'a b' is no name: write letters, digits and '_', and begin with no digit.");
    EXPECT_EQ(renamed("m.lsys", "lsys s {\n  axiom `A\n  A -> F\n}", "F", '`'),
              "refused: 'F' has a meaning of its own in strings.");
    EXPECT_EQ(renamed("m.lsys", "lsys s {\n  axiom `F\n  F -> FF\n}", "G", '`'),
              "refused: 'F' is a symbol of the turtle.");
    // Longest names win: 'BudX' would swallow the X behind a Bud.
    EXPECT_EQ(renamed("m.lsys", "lsys s {\n  modules Bud, `Leaf\n  axiom BudX Leaf\n  Bud -> F\n  X -> F\n}",
                      "BudX", '`'),
              "refused: 'BudX' already has a meaning where 'Leaf' stands.");
    EXPECT_EQ(renamed("m.rifs", "rifs c { map d { ^scale 1/2 } }", "x"), "refused: There is no name.");
    EXPECT_EQ(renamed("m.rifs", "let ^a = \nrifs c { map d { scale a } }", "x"),
              "refused: Mend the errors of the text first: its names are not all known.");
}

} // namespace
} // namespace graftal
