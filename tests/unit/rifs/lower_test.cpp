#include "compiler/rifs/lower.h"

#include <cmath>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "compiler/graph/text/print.h"
#include "compiler/graph/verify.h"
#include "compiler/languages/lower.h"

namespace graftal {
namespace {

struct Lowered {
    SourceMap sources;
    Diagnostics diagnostics;
    std::optional<Graph> graph;
    std::string messages; ///< rendered
};

Lowered lower(const std::string& text, const LowerOptions& options = {}) {
    Lowered result;
    result.graph = lower_text("m.rifs", text, options, result.sources, result.diagnostics).graph;
    result.messages = result.diagnostics.render(result.sources);
    return result;
}

/// The graph of a text that has to be in order.
Graph graph_of(const std::string& text) {
    Lowered lowered = lower(text);
    EXPECT_EQ(lowered.messages, "");
    EXPECT_TRUE(lowered.graph);
    return lowered.graph ? std::move(*lowered.graph) : Graph();
}

/// The messages, each as `line:column: message`, warnings with a `w` in front.
std::string messages_of(const std::string& text, const LowerOptions& options = {}) {
    Lowered lowered;
    lowered.graph = lower_text("m.rifs", text, options, lowered.sources, lowered.diagnostics).graph;
    std::string out;
    for (const Diagnostic& d : lowered.diagnostics.all()) {
        const Position at = lowered.sources.position(d.span.file, d.span.begin);
        if (d.severity == Severity::warning) out += "w ";
        out += std::to_string(at.line) + ":" + std::to_string(at.column) + ": " + d.message + "\n";
    }
    EXPECT_EQ(lowered.graph.has_value(), !lowered.diagnostics.has_errors());
    return out;
}

const Object& object(const Graph& graph, const std::string& name) {
    for (const Object& o : graph.objects)
        if (o.name == name) return o;
    ADD_FAILURE() << "no object " << name;
    return graph.objects.front();
}

/// The names of the masters, in order.
std::string masters(const Graph& graph, const std::string& name) {
    std::string out;
    for (const Instance& instance : object(graph, name).instances)
        out += (out.empty() ? "" : " ") + graph.objects[instance.master].name;
    return out;
}

void expect_near(const Affine& a, const Affine& b) {
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            EXPECT_NEAR(a.linear[column][row], b.linear[column][row], 1e-15) << column << row;
    for (int row = 0; row < 3; ++row)
        EXPECT_NEAR(a.translation[row], b.translation[row], 1e-15);
}

/// Two halves of a segment, and what is to be tried.
std::string two_maps(const std::string& more) {
    return "rifs r {\n  map a { scale 1/2 }\n  map b { scale 1/2 translate 1, 0 }\n" + more + "\n}\n";
}

TEST(LowerRifs, oneObjectAMapAndARootAsHartHasIt) {
    const Graph graph = graph_of(R"(rifs pound {
  map ll { scale 1/2 translate <-1/2, -1/2> tint rgb <1, 0, 0> .5 }
  map lr { scale 1/2 translate <1/2, -1/2> }
  map ul { scale 1/2 translate <-1/2, 1/2> }
  map ur { scale 1/2 translate <1/2, 1/2> }
  follow all except self
  terminal cube scale <1, 1, .02> below 12
})");
    EXPECT_EQ(graph.objects[graph.root].name, "pound");
    EXPECT_EQ(masters(graph, "pound"), "ll lr ul ur");
    EXPECT_EQ(masters(graph, "ll"), "lr ul ur");
    EXPECT_EQ(masters(graph, "ul"), "ll lr ur");
    const Affine half = Affine::translate({-.5, -.5, 0}) * Affine::scale(Vec3(.5));
    for (const Instance& instance : object(graph, "ll").instances) {
        EXPECT_EQ(instance.parent_from_child, half);
        EXPECT_EQ(instance.tint, (Tint{{1, 0, 0}, .5}));
    }
    for (const Instance& instance : graph.objects[graph.root].instances) {
        EXPECT_EQ(instance.parent_from_child, Affine());
        EXPECT_EQ(instance.tint, Tint());
    }
    const Affine slab = Affine::scale({1, 1, .02});
    EXPECT_EQ(graph.objects[graph.root].terminal->parent_from_child, slab);
    EXPECT_EQ(object(graph, "ll").terminal->parent_from_child, half * slab);
    EXPECT_EQ(object(graph, "ll").terminal->tint, (Tint{{1, 0, 0}, .5}));
    EXPECT_EQ(object(graph, "ll").terminal_px, 12);
}

TEST(LowerRifs, anEdgeLeadsFromTheMapThatIsAppliedFirst) {
    EXPECT_EQ(masters(graph_of(two_maps("follow a -> b  b -> a, b")), "a"), "b");
    EXPECT_EQ(masters(graph_of(two_maps("follow a -> b\nfollow { b -> a, b }")), "b"), "a b");
    EXPECT_EQ(masters(graph_of(two_maps("follow matrix {\n 0 1\n (1) 1/1\n}")), "b"), "a b");
    EXPECT_EQ(masters(graph_of(two_maps("follow matrix {\n 0 1\n .25, .75\n}")), "a"), "b");
    EXPECT_EQ(masters(graph_of(two_maps("follow all except b -> b")), "b"), "a");
    EXPECT_EQ(masters(graph_of(two_maps("follow all except { a -> a  b -> b }")), "b"), "a");
    EXPECT_EQ(masters(graph_of(two_maps("")), "b"), "a b");
}

TEST(LowerRifs, rowsOfCodesBecomeTheirMaps) {
    const Graph graph = graph_of(R"(rifs fern {
  codes 2d {
    stem: 0 0 0 .16 0 0 .01
    .85 .04 -.04 .85 0 1.6 .85
    -.15 .28 .26 .24 0 .44 .14 tint rgb <0, 1, 0> 1/4
  }
  codes polar { p: 2/3 1/2 90 -30 5 6 }
  codes 3d { 1/2 0 .1  .2 1/2 0  0 .3 1/2  7 8 9 }
})");
    EXPECT_EQ(masters(graph, "fern"), "stem w2 w3 p w5");
    const auto map = [&](const char* name) { return object(graph, name).instances.at(0).parent_from_child; };
    expect_near(map("stem"), {Mat3(0, 0, 0, 0, .16, 0, 0, 0, 0), Vec3(0)});
    expect_near(map("w2"),
                {Mat3(.85, -.04, 0, .04, .85, 0, 0, 0, std::sqrt(.85 * .85 + .04 * .04)), {0, 1.6, 0}});
    expect_near(map("w3"),
                {Mat3(-.15, .26, 0, .28, .24, 0, 0, 0, std::sqrt(.15 * .24 + .28 * .26)), {0, .44, 0}});
    // x' = r cos(theta) x - q sin(phi) y + e, y' = r sin(theta) x + q cos(phi) y + f
    const double c = std::sqrt(3) / 2;
    expect_near(map("p"), {Mat3(0, 2. / 3, 0, .25, c / 2, 0, 0, 0, std::sqrt(2. / 3 * .25)), {5, 6, 0}});
    expect_near(map("w5"), {glm::transpose(Mat3(.5, 0, .1, .2, .5, 0, 0, .3, .5)), {7, 8, 9}});
    EXPECT_EQ(object(graph, "w3").instances.at(0).tint, (Tint{{0, 1, 0}, .25}));
    EXPECT_FALSE(object(graph, "w3").terminal);
}

TEST(LowerRifs, flatRowsStaySimilaritiesAtAnyScale) {
    for (const std::string size : {"1e-99", "1e99", ".5"}) {
        const Graph graph = graph_of("rifs r { codes 2d { a: 0 -" + size + " " + size + " 0 0 0 } }");
        const Vec3 sigma = singular_values(object(graph, "a").instances.at(0).parent_from_child.linear);
        EXPECT_NEAR(sigma.z / sigma.x, 1, 1e-12) << size;
    }
}

TEST(LowerRifs, condensationIsDrawnUnderEveryMapAndAtTheRoot) {
    const Graph graph = graph_of(R"(material wood { color: .5, .3, .1 }
rifs tree {
  map a { scale 1/2 translate 0, 1, 0 tint 0, 0, 0, .5 material wood }
  condense cylinder scale <.1, 1, .1> tint 1, 1, 1, .5
  condense sphere
})");
    EXPECT_EQ(masters(graph, "tree"), "cylinder sphere a");
    EXPECT_EQ(masters(graph, "a"), "cylinder sphere a");
    const Affine map = Affine::translate({0, 1, 0}) * Affine::scale(Vec3(.5));
    const std::vector<Instance>& a = object(graph, "a").instances;
    EXPECT_EQ(a[0].parent_from_child, map * Affine::scale({.1, 1, .1}));
    // Half black before half white: a quarter is seen of the white, a quarter of what is below.
    EXPECT_NEAR(a[0].tint.alpha, .75, 1e-15);
    EXPECT_NEAR(a[0].tint.rgb.r, 1. / 3, 1e-15);
    EXPECT_EQ(a[1].tint, (Tint{{0, 0, 0}, .5}));
    EXPECT_EQ(a[0].material, 0u);
    const std::vector<Instance>& root = object(graph, "tree").instances;
    EXPECT_EQ(root[0].parent_from_child, Affine::scale({.1, 1, .1}));
    EXPECT_EQ(root[0].tint, (Tint{{1, 1, 1}, .5}));
    EXPECT_FALSE(root[0].material);
}

TEST(LowerRifs, aPartsOwnMaterialIsNearestToThePrimitive) {
    const Graph graph = graph_of(R"(material wood { color: .5, .3, .1 }
material leaf { color: 0, 1, 0 }
rifs tree { map a { scale 1/2 material wood } terminal sphere material leaf })");
    EXPECT_EQ(object(graph, "a").terminal->material, 1u);
    EXPECT_EQ(object(graph, "a").instances[0].material, 0u);
}

TEST(LowerRifs, blocksTakeEachOther) {
    const Graph graph = graph_of(R"(rifs one {
  map a { scale 1/2 }
  map b from two { scale 1/3 }
  condense sphere
  terminal cube
}
main rifs two {
  map a from one { scale 1/4  terminal torus }
  map c from one { scale 1/5 }
  terminal cylinder scale 2
}
rifs three { map z from one { scale 2 } start z })");
    EXPECT_EQ(graph.objects[graph.root].name, "two");
    EXPECT_EQ(masters(graph, "two"), "two.a two.c");
    EXPECT_EQ(masters(graph, "one.a"), "sphere one.a one.b");
    EXPECT_EQ(masters(graph, "one.b"), "two.a two.c"); // the attractor of `two`, which condenses nothing
    EXPECT_EQ(masters(graph, "two.a"), "sphere one.a one.b"); // with the condensation of `one`
    EXPECT_EQ(masters(graph, "three.z"), "sphere one.a one.b");
    // The terminal stands in for what the map is applied to.
    const auto terminal = [&](const char* name) { return *object(graph, name).terminal; };
    EXPECT_EQ(graph.objects[terminal("one.a").master].name, "cube");
    EXPECT_EQ(graph.objects[terminal("one.b").master].name, "cylinder");
    EXPECT_EQ(graph.objects[terminal("two.a").master].name, "torus");
    EXPECT_EQ(graph.objects[terminal("two.c").master].name, "cube");
    EXPECT_EQ(graph.objects[terminal("two").master].name, "cylinder");
    EXPECT_NEAR(terminal("one.b").parent_from_child.linear[0][0], 2. / 3, 1e-15);
}

TEST(LowerRifs, theLastBlockIsTheModel) {
    EXPECT_EQ(masters(graph_of("rifs x { map a { scale 1/2 } } rifs y { map a from x { scale 1 } }"), "y"),
              "y.a");
}

TEST(LowerRifs, startLimitsTheRoot) {
    EXPECT_EQ(masters(graph_of(two_maps("start b")), "r"), "b");
}

TEST(LowerRifs, aMapNamedAsItsBlockIsQualified) {
    EXPECT_EQ(masters(graph_of("rifs r { map r { scale 1/2 } map s { scale 1/3 } }"), "r.r"), "r.r r.s");
}

TEST(LowerRifs, deadMapsAreDroppedWithAWarning) {
    // c needs b, b needs a, and nothing leads to a.
    const std::string text = R"(rifs r {
  map a { scale 1/2 }
  map b { scale 1/2 }
  map c { scale 1/2 }
  map d { scale 1/2 }
  follow a -> b  b -> c  d -> d
  terminal cube
  %
})";
    const auto with = [&](const std::string& more) {
        return std::string(text).replace(text.find('%'), 1, more);
    };
    EXPECT_EQ(messages_of(with("")),
              "w 2:7: map 'a' draws nothing: no map leads to it\n"
              "w 3:7: map 'b' draws nothing: only maps that draw nothing lead to it\n"
              "w 4:7: map 'c' draws nothing: only maps that draw nothing lead to it\n");
    EXPECT_EQ(masters(*lower(with("")).graph, "r"), "d");
    EXPECT_NE(
        messages_of(with("start a, b")).find("1:6: 'rifs r' is empty: no sequence of its maps is endless"),
        std::string::npos);
    const Graph condensed = graph_of(with("condense sphere"));
    EXPECT_EQ(masters(condensed, "a"), "sphere");
    EXPECT_EQ(masters(condensed, "c"), "sphere b");
}

TEST(LowerRifs, emptyBlocksEmptyThoseThatTakeThem) {
    EXPECT_EQ(
        messages_of("rifs x { map a from y { scale 1/2 } }\nrifs y { map b from x { scale 1/2 } "
                    "map c { scale 1/2 } follow c -> c start b }\nrifs z { map d from x { scale 1 } }\n"),
        ""); // a takes b, and b takes a: a cycle
    EXPECT_EQ(messages_of("rifs x { map a { scale 1/2 } map b { scale 1/2 } follow a -> b }\n"
                          "rifs y { map c from x { scale 1 } map d { scale 1/2 } }\n"),
              "w 1:14: map 'a' draws nothing: no map leads to it\n"
              "w 1:34: map 'b' draws nothing: only maps that draw nothing lead to it\n"
              "w 2:14: map 'c' draws nothing: only maps that draw nothing lead to it\n");
}

TEST(LowerRifs, namesThatAreNotThere) {
    EXPECT_EQ(lower(two_maps("follow a -> bb")).messages, "m.rifs:4:13: error: 'rifs r' has no map 'bb'\n"
                                                          "    follow a -> bb\n"
                                                          "                ^~\n"
                                                          "    hint: did you mean 'b'? known here: a, b\n");
    EXPECT_EQ(messages_of(two_maps("start q\nterminal cbue\ncondense leaf")),
              "5:10: 'cbue' is neither a primitive nor a used model\n"
              "6:10: 'leaf' is neither a primitive nor a used model\n"
              "4:7: 'rifs r' has no map 'q'\n");
    EXPECT_EQ(messages_of("rifs r { map a from s { scale 1/2 } map b { scale 1/2 material wodo } }"),
              "1:64: unknown material 'wodo'\n"
              "1:21: unknown rifs 's'\n");
}

TEST(LowerRifs, duplicatesPointAtTheFirst) {
    EXPECT_EQ(lower("rifs r {\n  map a { scale 1/2 }\n  codes 2d { a: .5 0 0 .5 0 0 }\n}\n").messages,
              "m.rifs:3:14: error: duplicate map 'a'\n"
              "      codes 2d { a: .5 0 0 .5 0 0 }\n"
              "                 ^\n"
              "m.rifs:2:7: note: first defined here\n"
              "      map a { scale 1/2 }\n"
              "          ^\n");
    EXPECT_EQ(lower("rifs r { map a { scale 1/2 } }\nrifs r { map a { scale 1/2 } }\n").messages,
              "m.rifs:2:6: error: duplicate rifs 'r'\n"
              "    rifs r { map a { scale 1/2 } }\n"
              "         ^\n"
              "m.rifs:1:6: note: first defined here\n"
              "    rifs r { map a { scale 1/2 } }\n"
              "         ^\n");
    EXPECT_EQ(lower(two_maps("follow a -> a, b, a")).messages,
              "m.rifs:4:19: warning: the edge 'a -> a' is given twice\n"
              "    follow a -> a, b, a\n"
              "                      ^\n"
              "m.rifs:4:13: note: first given here\n"
              "    follow a -> a, b, a\n"
              "                ^\n");
    EXPECT_EQ(messages_of("main rifs r { map a { scale 1/2 } }\nmain rifs s { map a { scale 1/2 } }\n"),
              "2:11: a second 'main' block\n");
    // w2 is the second map's name, if it has no label.
    EXPECT_EQ(messages_of("rifs r { codes 2d {\n w2: .5 0 0 .5 0 0\n .5 0 0 .5 1 0\n } }"),
              "3:2: duplicate map 'w2'\n");
}

TEST(LowerRifs, namesThatCannotBe) {
    EXPECT_EQ(messages_of("rifs sphere { map cube { scale 1/2 } map a.b { scale 1/2 } }"),
              "1:6: 'sphere' is a primitive and cannot name a block\n"
              "1:19: 'cube' is a primitive and cannot name a map\n"
              "1:42: the name 'a.b' of a map must not have a '.'\n");
}

TEST(LowerRifs, matricesOfTheWrongShapeOrRange) {
    EXPECT_EQ(messages_of(two_maps("follow matrix {\n0 1\n}")),
              "4:1: the matrix has 1 row, but 'rifs r' has 2 maps\n");
    EXPECT_EQ(messages_of(two_maps("follow matrix {\n0 1\n1\n}")),
              "6:1: row 2 of the matrix has 1 entry, but 'rifs r' has 2 maps\n");
    EXPECT_EQ(messages_of(two_maps("follow matrix {\n0 -1\n1 2\n}")),
              "5:3: an entry must lie between 0 and 1, not -1\n"
              "6:3: an entry must lie between 0 and 1, not 2\n");
    EXPECT_EQ(messages_of(two_maps("follow matrix {\n0 1\n.5 .4\n}")),
              "w 6:1: the probabilities of row 2 do not add up to 1\n");
}

TEST(LowerRifs, aRowOfZerosIsABall) {
    EXPECT_EQ(messages_of("rifs r { codes 2d {\n .5 0 0 .5 0 0 .5\n 0 -0 0 0 1 2 .5\n} }"),
              "w 3:2: this row maps everything to one point; a small ball stands for it\n");
    EXPECT_EQ(messages_of("rifs r { codes polar {\n .5 .5 0 0 0 0\n 0 0 9 9 1 2\n} }"),
              "w 3:2: this row maps everything to one point; a small ball stands for it\n");
    EXPECT_EQ(messages_of("rifs r { codes 2d {\n .5 0 0 .5 0 0\n 0 0 0 0 1 2\n} start w2 }"),
              "3:2: this row maps everything to one point\n");
    EXPECT_EQ(messages_of("rifs r { codes 2d {\n 0 0 0 0 1 2\n} }"),
              "2:2: this row maps everything to one point\n");
    // The rows behind it keep their names.
    EXPECT_EQ(messages_of("rifs r { codes 2d {\n 0 0 0 0 1 2\n .5 0 0 .5 0 0\n w2: .5 0 0 .5 1 0\n} }"),
              "w 2:2: this row maps everything to one point; a small ball stands for it\n"
              "4:2: duplicate map 'w2'\n");
}

TEST(LowerRifs, mapsThatCannotBe) {
    EXPECT_EQ(
        messages_of(
            "rifs r { codes 2d {\n 0 0 0 0 1 2\n 1e200*1e200 0 0 1 0 0\n 1/0 0 0 1 0 0\n} follow all }"),
        "2:2: this row maps everything to one point\n"
        "3:2: 1e+200 * 1e+200 is not a finite number\n"
        "4:2: division by zero\n");
    EXPECT_EQ(messages_of("rifs r { map a { scale <1/2, 0> } }"),
              "1:18: this scale is singular: it flattens what it maps\n");
    EXPECT_EQ(messages_of("rifs r { map a { scale 1/2 probability -.1 } codes 2d { 1 0 0 1 0 0 1.5 } }"),
              "1:40: a probability must lie between 0 and 1, not -0.1\n"
              "1:69: a probability must lie between 0 and 1, not 1.5\n");
    const auto hint = [](const std::string& text) {
        SourceMap sources;
        Diagnostics diagnostics;
        lower_text("m.rifs", text, {}, sources, diagnostics);
        return diagnostics.all().empty() ? "" : diagnostics.all().front().hint;
    };
    EXPECT_EQ(
        hint("rifs r { codes 2d {\n.5 0 0 .5 0 0 1\n.5 0 0 .5 1 0 -.2\n} }"),
        "it is the last number of row 2: remove the last number from all rows to choose maps by their size");
    EXPECT_EQ(messages_of("rifs r { codes 2d {\n.5 0 0 .5 0 0 .3\n.5 0 0 .5 1 0 .3\n} }"),
              "w 1:6: the probabilities of 'rifs r' add up to 0.6, not 1\n");
    EXPECT_EQ(messages_of("rifs r { codes 2d {\n 0 0 0 .5 0 0\n .5 0 0 .5 0 1\n }\n"
                          " terminal cylinder projection 1, 0, 0, 0,  0, 0, 0, 0,  0, 0, 0, 0 }"),
              "5:2: under map 'w1' this vanishes\n");
}

TEST(LowerRifs, blocksThatCannotBe) {
    EXPECT_EQ(messages_of("rifs r { terminal cube }"), "1:6: 'rifs r' has no maps\n");
    EXPECT_EQ(messages_of("let a = 1"), "1:1: this file has no 'rifs' block\n");
    EXPECT_EQ(messages_of(""), "1:1: this file has no 'rifs' block\n");
    EXPECT_EQ(
        lower("rifs x {\n map a { scale 1/2 }\n map b from x { scale 1/2 }\n follow a -> b\n}").messages,
        "m.rifs:4:14: error: 'b' takes 'rifs x', so no map of its own block leads to it\n"
        "     follow a -> b\n"
        "                 ^\n"
        "m.rifs:3:13: note: given here\n"
        "     map b from x { scale 1/2 }\n"
        "                ^\n");
    EXPECT_EQ(messages_of(two_maps("condense plane")), "2:7: 'a' contains itself and a plane\n");
}

TEST(LowerRifs, allErrorsOfAFileAreReportedInOneRun) {
    EXPECT_EQ(
        messages_of("camera { angle: 200 }\nrifs r {\n  map a { scle 1 }\n  map b { scale nope }\n"
                    "  follow a -> c\n  terminal x\n}\n"),
        "3:11: expected a transform, 'tint', 'material', 'probability', 'terminal' or '}', found 'scle'\n"
        "1:17: 'angle' must lie between 0 and 180 degrees, not 200\n"
        "4:17: unknown name 'nope'\n"
        "6:12: 'x' is neither a primitive nor a used model\n"
        "5:15: 'rifs r' has no map 'c'\n");
}

TEST(LowerRifs, tooManyInstancesAreRefusedBeforeTheyAreMade) {
    std::string text = "rifs r { codes 2d {\n";
    for (int row = 0; row < 100'000; ++row)
        text += ".5 0 0 .5 0 0\n";
    const std::string said = messages_of(text + "} }");
    EXPECT_EQ(said.substr(0, 5), "1:6: ") << said;
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;

    text = "rifs r { codes 2d {\n";
    for (int row = 0; row < 5000; ++row)
        text += ".5 0 0 .5 0 0\n";
    text += "} follow w1 -> w1\n";
    for (int part = 0; part < 1000; ++part)
        text += "condense cube\n";
    EXPECT_EQ(messages_of(text + "}"), "1:6: the model has more than 4000000 instances\n");

    LowerOptions small;
    small.max_objects = 3;
    EXPECT_EQ(messages_of(two_maps(""), small), "");
    small.max_objects = 2;
    EXPECT_EQ(messages_of(two_maps(""), small), "1:6: the model has more than 2 objects\n");
}

// Chances are made shares of one sum: one at the end of the range would leave it.
TEST(LowerRifs, aChanceThatIsTooSmallIsNone) {
    const Graph graph =
        graph_of("rifs r { codes 2d {\n.5 0 0 .5 0 0 1e-100\n.5 0 0 .5 1 0 1\n} terminal cube }");
    Diagnostics diagnostics;
    SourceMap sources;
    const auto again = lower_text("m.inst", print(graph), {}, sources, diagnostics).graph;
    ASSERT_TRUE(again) << diagnostics.render(sources);
    EXPECT_TRUE(equal(graph, *again));
}

TEST(LowerRifs, aLongCycleIsLegal) {
    std::string text = "rifs r { codes 2d {\n";
    std::string follow = "} follow {\n";
    const int size = 20'000;
    for (int i = 1; i <= size; ++i) {
        text += ".5 0 0 .5 0 0\n";
        follow += "w" + std::to_string(i) + " -> w" + std::to_string(i % size + 1) + "\n";
    }
    const Graph graph = graph_of(text + follow + "} start w1 terminal cube }");
    EXPECT_EQ(graph.objects.size(), size + 2u);
}

TEST(LowerRifs, manyUnknownNamesTakeNoTime) {
    std::string text = "rifs r { codes 2d {\n";
    for (int i = 0; i < 20'000; ++i)
        text += "name_that_is_fairly_long_" + std::to_string(i) + ": .5 0 0 .5 0 0\n";
    text += "} follow {\n";
    for (int i = 0; i < 1000; ++i)
        text += "name_that_is_unknown_" + std::to_string(i) + " -> x\n";
    EXPECT_FALSE(lower(text + "} }").graph);
}

TEST(LowerRifs, manyUnknownBlocksTakeNoTime) {
    std::string text;
    for (int i = 0; i < 1000; ++i)
        text += "rifs name_that_is_fairly_long_" + std::to_string(i) + " { map a { scale 1/2 } }\n";
    text += "rifs r {\n";
    for (int i = 0; i < 20'000; ++i)
        text += "map m" + std::to_string(i) + " from name_that_is_unknown { scale 1/2 }\n";
    EXPECT_NE(lower(text + "}").messages.find("unknown rifs 'name_that_is_unknown'"), std::string::npos);
}

TEST(LowerRifs, manyPrimitivesOfNumbersAreFoundAtOnce) {
    std::string text = "rifs r { map a { scale 1/2 } map b { scale 1/2 translate 1, 0, 0 }\n";
    constexpr int count = 40'000;
    for (int i = 0; i < count; ++i) // each twice
        text += "condense superellipsoid(" + std::to_string(0.1 + 1e-5 * (i / 2)) + ", 1)\n";
    const Graph graph = graph_of(text + "}");
    EXPECT_EQ(graph.objects.size(), count / 2 + 3u);
}

std::string said_of_orbit(const std::string& lines) {
    LowerOptions options;
    options.may_be_orbit = true;
    return lower("orbit o {\n" + lines + "}\n", options).messages;
}

/// Each function calls the one before on its argument, negated so many times.
std::string nested_functions(int count, int signs) {
    std::string text = "f0(t) = t\n";
    for (int i = 1; i < count; ++i) {
        text += "f" + std::to_string(i) + "(t) = f" + std::to_string(i - 1) + "(";
        for (int k = 0; k < signs; ++k)
            text += "-(";
        text += "t" + std::string(static_cast<std::size_t>(signs), ')') + ")\n";
    }
    return text + "x = f" + std::to_string(count - 1) + "(x)  y = y\n";
}

// Recursion follows the formulas: they went beyond the stack.
TEST(LowerRifs, functionsOfAnOrbitNestToALimit) {
    EXPECT_EQ(said_of_orbit(nested_functions(20, 90)), "");
    EXPECT_NE(said_of_orbit(nested_functions(900, 90)).find("this formula nests more than 2000 deep"),
              std::string::npos);
}

TEST(LowerRifs, allFormulasOfAnOrbitAreBounded) {
    std::string functions = "f0(t) = t + t\n", lets;
    for (int i = 1; i < 12; ++i)
        functions += "f" + std::to_string(i) + "(t) = f" + std::to_string(i - 1) + "(t) + f" +
                     std::to_string(i - 1) + "(t)\n";
    for (int i = 0; i < 900; ++i)
        lets += "let a" + std::to_string(i) + " = f11(x)\n";
    const std::string message = "the formulas of 'orbit o' have more than 2000000 words";
    EXPECT_NE(said_of_orbit(functions + "map m {\n" + lets + "x = x  y = y }\n").find(message),
              std::string::npos);
    EXPECT_EQ(said_of_orbit(functions + "x = f11(x)*1e-9  y = f11(y)*1e-9\n"), "");
}

// A point begins anew in a condensation set with its probability, whether that of the maps is stated or not.
TEST(LowerRifs, mapsLeaveCondensationSetsTheirProbability) {
    const std::string set = "condense sphere scale 0.01 probability 0.25 }",
                      half = "map a { scale 1/2 probability 0.5 }";
    EXPECT_TRUE(equal(graph_of("rifs r { map a { scale 1/2 }\n" + set),
                      graph_of("rifs r { map a { scale 1/2 probability 0.75 }\n" + set)));
    EXPECT_TRUE(equal(graph_of("rifs r { " + half + " map b { scale 1/3 }\n" + set),
                      graph_of("rifs r { " + half + " map b { scale 1/3 probability 0.25 }\n" + set)));
}

} // namespace
} // namespace graftal
