#include "compiler/rifs/parser.h"

#include <string>

#include <gtest/gtest.h>

namespace graftal {
namespace {

struct Parsed {
    SourceMap sources;
    Diagnostics diagnostics;
    RifsFile file;
};

void parse(const std::string& text, Parsed& parsed) {
    const FileId file = parsed.sources.add("m.rifs", text);
    parsed.file = parse_rifs(parsed.sources, file, parsed.diagnostics);
}

/// The messages of a text, each as `line:column: message`.
std::string complaints(const std::string& text) {
    Parsed parsed;
    parse(text, parsed);
    std::string out;
    for (const Diagnostic& d : parsed.diagnostics.all()) {
        const Position at = parsed.sources.position(d.span.file, d.span.begin);
        out += std::to_string(at.line) + ":" + std::to_string(at.column) + ": " + d.message + "\n";
    }
    return out;
}

/// The rows of `codes 2d` that hold `text`.
std::vector<RifsMap> rows(const std::string& text) {
    Parsed parsed;
    parse("rifs r {\ncodes 2d {\n" + text + "\n}\n}\n", parsed);
    EXPECT_EQ(parsed.diagnostics.render(parsed.sources), "");
    return parsed.file.blocks.at(0).maps;
}

TEST(RifsParser, readsEveryItemOfABlock) {
    Parsed parsed;
    parse(R"(use leaf = "leaf.inst"
let s = 1/2
main rifs r {
  map a { scale: s  tint: 1, 0, 0, .5  material red  probability 1/3 }
  map b from other { scale s translate <1, 2>  terminal cube scale 2 }
  codes 3d { c: 1 0 0  0 1 0  0 0 1  0 0 0  .5 tint rgb <0, 0, 0> 1 material red }
  condense leaf scale 2 tint 0, 0, 0, 1
  condense sphere
  terminal cube translate 1, 2, 3
  follow a -> b, c
  follow { b -> a, c -> a }
  start a, b
}
rifs other { codes polar { 1 1 0 0 0 0 } }
)",
          parsed);
    ASSERT_EQ(parsed.diagnostics.render(parsed.sources), "");
    ASSERT_EQ(parsed.file.blocks.size(), 2u);
    EXPECT_EQ(parsed.file.uses.at(0).path, "leaf.inst");
    EXPECT_EQ(parsed.file.statements.size(), 1u);
    const RifsBlock& block = parsed.file.blocks[0];
    EXPECT_TRUE(block.is_main);
    ASSERT_EQ(block.maps.size(), 3u);
    EXPECT_EQ(block.maps[0].look.tint.size(), 4u);
    EXPECT_EQ(block.maps[0].look.material->text, "red");
    EXPECT_TRUE(block.maps[0].probability);
    EXPECT_EQ(block.maps[1].from->text, "other");
    EXPECT_EQ(block.maps[1].transforms.size(), 2u);
    EXPECT_EQ(block.maps[1].terminal->transforms.size(), 1u);
    EXPECT_EQ(block.maps[2].form, RifsForm::codes_3d);
    EXPECT_EQ(block.maps[2].codes.size(), 12u);
    EXPECT_TRUE(block.maps[2].probability);
    EXPECT_EQ(block.condense.size(), 2u);
    EXPECT_EQ(block.terminal->master.text, "cube");
    ASSERT_EQ(block.follow->edges.size(), 4u);
    EXPECT_EQ(block.follow->edges[3].from.text, "c");
    EXPECT_EQ(block.start.size(), 2u);
    EXPECT_EQ(parsed.file.blocks[1].maps[0].form, RifsForm::codes_polar);
}

TEST(RifsParser, aSignCloseToItsNumberBeginsAColumn) {
    const auto six = rows(".2 -.26 .23 -.22 -0 +1.6");
    EXPECT_EQ(six.at(0).codes.size(), 6u);
    EXPECT_FALSE(six.at(0).probability);
    const auto joined = rows("1 - 2 3 4 5 6 7\n1-2 3 4 5 6 7");
    ASSERT_EQ(joined.size(), 2u);
    EXPECT_EQ(joined[0].codes.size(), 6u);
    EXPECT_EQ(joined[1].codes.size(), 6u);
    EXPECT_EQ(joined[0].codes[0].kind, Expression::Kind::binary);
}

TEST(RifsParser, rowsTakeFractionsParenthesesCommasAndNames) {
    const auto row = rows("1/3 -1/3 (1 - 2*s) sqrt(2) s, -s");
    EXPECT_EQ(row.at(0).codes.size(), 6u);
}

TEST(RifsParser, aRowEndsWithItsLineEvenAfterATint) {
    const auto two = rows("1 0 0 1 0 0 tint rgb <0, 0, 0> .5\n-1 0 0 1 0 0 tint 0, 0, 0, s\n-.5 0 0 1 0 0");
    ASSERT_EQ(two.size(), 3u);
    EXPECT_EQ(two[0].look.tint.at(3).number, .5);
    EXPECT_EQ(two[2].codes.size(), 6u);
}

TEST(RifsParser, wrongColumnCountsNameTheColumns) {
    EXPECT_EQ(complaints("rifs r {\n  codes 2d {\n    1 2 3 4 5\n    a: 1 2 3 4 5 6 7 8\n  }\n"
                         "  codes polar { 1 }\n  codes 3d { 1 2 3 4 5 6 7 8 9 10 11 }\n}"),
              "3:5: a row of 'codes 2d' takes 6 or 7 numbers (a b c d e f [p]), not 5\n"
              "4:8: a row of 'codes 2d' takes 6 or 7 numbers (a b c d e f [p]), not 8\n"
              "6:17: a row of 'codes polar' takes 6 or 7 numbers (r q theta phi e f [p]), not 1\n"
              "7:14: a row of 'codes 3d' takes 12 or 13 numbers (a b c d e f g h i tx ty tz [p]), not 11\n");
}

TEST(RifsParser, goesOnAfterEachError) {
    EXPECT_EQ(
        complaints(R"(rifs r {
  map { scale 1 }
  map b { scle 1/2 }
  map c { scale }
  codes 4d { 1 }
  codes 2d { x: }
  follow nothing
  follow a ->
  condense 3
  strat a
  tint 1
  map z { scale 1/2 tint 0, 0, 0, 1 tint 0, 0, 0, 1 }
  follow all except
  follow matrix all
}
garbage { more { of } it }
rifs
use x "y"
)"),
        "2:7: expected a name after 'map', found '{'\n"
        "3:11: expected a transform, 'tint', 'material', 'probability', 'terminal' or '}', found 'scle'\n"
        "4:17: expected a number, found '}'\n"
        "5:9: expected '2d', 'polar', '3d' or 'barycentric' after 'codes', found '4'\n"
        "6:17: expected the numbers of 'x', found '}'\n"
        "8:3: expected '->' after 'nothing', found 'follow'\n"
        "9:3: expected the name of a map after '->', found 'condense'\n"
        "9:12: expected a primitive or a used model after 'condense', found '3'\n"
        "10:3: expected 'map', 'codes', 'follow', 'start', 'control', 'condense', 'terminal' or '}', found "
        "'strat'\n"
        "11:3: expected 'map', 'codes', 'follow', 'start', 'control', 'condense', 'terminal' or '}', found "
        "'tint'\n"
        "12:37: duplicate 'tint'\n"
        "14:3: expected the name of a map, found 'follow'\n"
        "14:17: expected '{' after 'matrix', found 'all'\n"
        "16:1: expected 'rifs', 'use' or a scene statement, found 'garbage'\n"
        "18:5: expected '{' after 'use', found 'x'\n");
}

TEST(RifsParser, duplicatesPointAtTheFirst) {
    Parsed parsed;
    parse("rifs r {\n  map a { scale 1/2 }\n  follow all\n  follow a -> a\n  terminal cube\n  terminal cube\n"
          "  start a\n  start a\n}\n",
          parsed);
    EXPECT_EQ(parsed.diagnostics.render(parsed.sources), "m.rifs:4:3: error: duplicate 'follow'\n"
                                                         "      follow a -> a\n"
                                                         "      ^~~~~~\n"
                                                         "m.rifs:3:3: note: first given here\n"
                                                         "      follow all\n"
                                                         "      ^~~~~~~~~~\n"
                                                         "m.rifs:6:3: error: duplicate 'terminal'\n"
                                                         "      terminal cube\n"
                                                         "      ^~~~~~~~\n"
                                                         "m.rifs:5:3: note: first given here\n"
                                                         "      terminal cube\n"
                                                         "      ^~~~~~~~~~~~~\n"
                                                         "m.rifs:8:3: error: duplicate 'start'\n"
                                                         "      start a\n"
                                                         "      ^~~~~\n"
                                                         "m.rifs:7:9: note: first given here\n"
                                                         "      start a\n"
                                                         "            ^\n");
}

TEST(RifsParser, aMissingBraceIsFoundWhereTheNextItemBegins) {
    EXPECT_EQ(complaints("rifs r {\n  map a { scale 1/2\n  map b { scale 1/2 }\n}\n"),
              "3:3: expected '}' at the end of 'map a', found 'map'\n");
    EXPECT_EQ(complaints("rifs r {\n  codes 2d {\n    1 0 0 1 0 0\n  follow all\n}\n"),
              "4:3: expected '}' at the end of 'codes', found 'follow'\n");
    EXPECT_EQ(complaints("rifs r {\n  map a { scale 1/2 }\nrifs s {\n  map a { scale 1/2 }\n}\n"),
              "3:1: expected '}' at the end of 'rifs r', found 'rifs'\n");
    EXPECT_EQ(complaints("rifs r {\n  map a { scale 1/2 }\n"),
              "2:22: expected '}' at the end of 'rifs r', found the end of the file\n");
}

TEST(RifsParser, sceneStatementsStandOutside) {
    EXPECT_EQ(complaints("rifs r {\n  map a { scale 1/2 }\n  steps 3\n  use x = \"y\"\n}\nsteps 4\n"),
              "3:3: 'steps' must be outside the braces of 'rifs r'\n"
              "4:3: 'use' must be outside the braces of 'rifs r'\n");
}

TEST(RifsParser, deepNestingIsOneError) {
    const std::string braces(100'000, '{');
    for (const std::string& text :
         {braces, "rifs r " + braces, "rifs r { map a " + braces, "rifs r { follow " + braces,
          "rifs r { codes 2d { 1 2 " + std::string(100'000, '(')})
        EXPECT_EQ(complaints(text).find("nest more than 256 deep"), complaints(text).rfind("nest more"))
            << text.size();
}

TEST(RifsParser, noPrefixHangsOrCrashes) {
    const std::string text = R"(use a = "b" main rifs r { map a from r { scale <1/2, 2> tint rgb <1,0,0> .5 }
      codes 2d { x: 1 2 3 (4 5 6 tint 1,2,3,4 } follow { a -> x, b c -> d } follow matrix { 0 1
      1 0 } follow all except self condense cube scale 2 start a, b } let x = 1)";
    for (std::size_t size = 0; size <= text.size(); ++size) {
        complaints(text.substr(0, size));
        complaints(text.substr(size));
    }
}

TEST(RifsParser, tooManyMapsAreRefused) {
    std::string text = "rifs r {\ncodes 2d {\n";
    for (std::size_t row = 0; row < max_rifs_maps + 10; ++row)
        text += "1 0 0 1 0 0\n";
    Parsed parsed;
    parse(text + "}\n}\n", parsed);
    ASSERT_EQ(parsed.diagnostics.error_count(), 1u);
    EXPECT_EQ(parsed.diagnostics.all()[0].message, "more than 100000 maps");
    EXPECT_EQ(parsed.file.blocks.at(0).maps.size(), max_rifs_maps);
}

} // namespace
} // namespace graftal
