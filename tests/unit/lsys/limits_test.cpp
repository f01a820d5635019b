// Models that are made to take too long, or too much memory: they are refused soon, or drawn soon.

#include <map>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "compiler/languages/lower.h"
#include "compiler/support/stage_work.h"

namespace graftal {
namespace {

using ::testing::HasSubstr;

/// What is said about a file; "" if it compiles.
std::string said(const std::string& text, const LowerOptions& options = {}) {
    SourceMap sources;
    Diagnostics diagnostics;
    const std::optional<Graph> graph = lower_text("m.lsys", text, options, sources, diagnostics).graph;
    EXPECT_EQ(graph.has_value(), !diagnostics.has_errors());
    return diagnostics.render(sources);
}

std::string block(const std::string& statements) {
    return "lsys test {\n" + statements + "\n}\n";
}

std::string numbered(int count, const char* separator, const std::string& name) {
    std::string text;
    for (int i = 0; i < count; ++i)
        text += fmt::format("{}{}{}", i == 0 ? "" : separator, name, i);
    return text;
}

TEST(LsysLimits, partsThatAllDiffer) {
    const std::string text = block("steps 10000\nwidth 1\naxiom A(1)\nA(n) -> F(n)[+A(n*1.01)]A(n+1)");
    LowerOptions options;
    options.max_objects = 12'000;
    EXPECT_THAT(said(text, options), HasSubstr("the model has more than 12000 different parts"));
}

TEST(LsysLimits, fingerprintsThatDoNotTellPartsApart) {
    // Bodies are tiny beside their distances; comparing each with all took minutes.
    LowerOptions options;
    options.max_objects = 100'000;
    EXPECT_THAT(said(block("steps 10000\nwidth 1\naxiom A(0)\nA(n) -> F(n+1)[+A(n+1)]A(n*1.1)"), options),
                HasSubstr("different parts"));
}

TEST(LsysLimits, polygons) {
    const auto polygon = [](const char* vertices, int steps) {
        return block(fmt::format("steps {}\naxiom {{A}}\nA -> {}", steps, vertices));
    };
    EXPECT_EQ(said(polygon("f+(179.3)A", 4000)), ""); // no corner is an ear: took the cube of the time
    EXPECT_THAT(said(polygon("f+AA", 64)), HasSubstr("a polygon has more than 10000 vertices"));
    EXPECT_THAT(said(polygon("f+{A}A", 2000)), HasSubstr("more than 1000 polygons are open in one place"));
    EXPECT_THAT(said(block("steps 2000\naxiom A}\nA -> {fA")),
                HasSubstr("more than 1000 polygons are open in one place"));
}

TEST(LsysLimits, distances) {
    // Was a transform that is not finite, which the verifier of graphs stops at.
    EXPECT_THAT(said(block("steps 10000\naxiom F\nF -> FF")), HasSubstr("goes beyond the range of numbers"));
    EXPECT_EQ(said(block("steps 300\naxiom F\nF -> FF")), "");
}

TEST(LsysLimits, sizesBeyondTheRange) {
    // Each was a broken invariant of the verifier, or of the writer.
    EXPECT_EQ(said(block("steps 2200\nwidth 0.1\naxiom X\nX -> F!X")), "");
    EXPECT_EQ(said(block("steps 0\naxiom !(5e-324)F")), "");
    EXPECT_EQ(said(block("steps 0\naxiom F(5e-324)@O(5e-324)~sphere(5e-324)~cube(5e-324,1)")), "");
    EXPECT_THAT(said(block("steps 0\nwidth 5e-324\naxiom F")),
                HasSubstr("m.lsys:3:7: error: 'width' must lie between 1e-100 and 1e+100, not 5e-324"));
    EXPECT_THAT(said(block("steps 0\nstep 1e101\naxiom F")),
                HasSubstr("'step' must lie between 1e-100 and 1e+100, not 1e+101"));
    EXPECT_THAT(said(block("steps 600\naxiom A(1)\nA(w) -> A(w*2)\ninterpret A(w) -> !(w)F")),
                HasSubstr("m.lsys:5:11: error: a width is at most 1e+100, not "));
    EXPECT_THAT(said(block("steps 0\naxiom [f(1e101)]F")),
                HasSubstr("a length is at most 1e+100, not 1e+101"));
    EXPECT_THAT(said(block("steps 0\naxiom @o(0-1e101)")), HasSubstr("a diameter is at most 1e+100"));
    EXPECT_THAT(said(block("steps 0\naxiom ~cube(1e200,1e-200)")),
                HasSubstr("the scale of a model is at most"));
    EXPECT_THAT(said(block("steps 0\naxiom ~cube(1e200,1e200)")), HasSubstr("not an infinite one"));
    EXPECT_THAT(said(block("steps 0\naxiom T(1e308)F~sphere")), HasSubstr("an elasticity is at most 1e+100"));
}

/// Different parts that a block makes.
std::size_t parts_of(const std::string& statements) {
    SourceMap sources;
    Diagnostics diagnostics;
    const std::optional<Derivation> derivation =
        lower_text("m.lsys", block(statements), {}, sources, diagnostics).notes.derivation;
    EXPECT_TRUE(derivation) << diagnostics.render(sources);
    return derivation ? derivation->parts : 0;
}

TEST(LsysLimits, stateOfTheTurtleThatGoesOnForEver) {
    // Each made a part for every module of the word.
    EXPECT_LT(parts_of("steps 30\nangle 60\naxiom X\nX -> FX+FX-FX;"), 300u); // colours are counted around
    EXPECT_LT(parts_of("steps 30\naxiom X\nX -> F;(1e9)X+,FX,"), 300u);
    EXPECT_LT(parts_of("steps 30\nangle 60\naxiom @GsX@Ge\nX -> FX+FX"), 100u); // far from a control point
    EXPECT_LT(parts_of("steps 30\nwidth 1\naxiom X\nX -> F!X+F![X]-X"), 3000u); // ever thinner
    EXPECT_LT(parts_of("steps 300\naxiom X\nX -> [{f+f+f.X}]+X"), 1000u);       // polygons in polygons
}

TEST(LsysLimits, coloursGoAroundInTheLimit) {
    EXPECT_EQ(said(block("angle 60\nsteps infinite\naxiom F\nF -> F+;F-F")), "");
}

TEST(LsysLimits, limitsThatDoNotRepeatAreGivenUpSoon) {
    // All of its directions were composed, for minutes.
    EXPECT_THAT(said(block("angle 68\ntropism 1,-1,0\nsteps infinite\naxiom T(0.86)F\nL -> F$F\nF -> F+FL")),
                HasSubstr("its levels do not repeat"));
}

TEST(LsysLimits, symbols) {
    const std::string names = numbered(66'000, ", ", "m");
    const std::string text =
        block("modules " + names + "\nsteps 1\naxiom F\nF -> F" + numbered(66'000, " ", "m"));
    EXPECT_THAT(said(text), HasSubstr("a block has at most 65535 different symbols"));
}

TEST(LsysLimits, parameters) {
    const std::string many = numbered(257, ", ", "x"), some = numbered(256, ", ", "x");
    EXPECT_THAT(said(block("steps 1\naxiom F\nF(" + many + ") -> F")),
                HasSubstr("a production and its contexts have at most 256 parameters"));
    EXPECT_THAT(said(block("let " + numbered(257, " = 1, ", "x") + " = 1\nsteps 1\naxiom F(" + many + ")")),
                HasSubstr("a module has at most 256 parameters"));
    EXPECT_EQ(said(block("steps 0\naxiom F(1)\nF(" + some + ") -> F(x255)")).find("error"),
              std::string::npos);
}

TEST(LsysLimits, blocksThatPlaceBlocks) {
    const auto chain = [](int count) {
        std::string text = "lsys b0 {\nsteps 0\naxiom F\n}\n";
        for (int i = 1; i < count; ++i)
            text = fmt::format("lsys b{} {{\nsteps 0\naxiom F~b{}\n}}\n{}", i, i - 1, text);
        return text + fmt::format("main lsys top {{\nsteps 0\naxiom ~b{}\n}}\n", count - 1);
    };
    EXPECT_EQ(said(chain(255)), "");
    EXPECT_THAT(said(chain(20'000)), HasSubstr("blocks place each other more than 256 deep"));
}

TEST(LsysLimits, runsOfSpacesAreReadOnce) {
    // Each space looked for what follows all of them.
    EXPECT_EQ(said(block("steps 0\naxiom F" + std::string(1'000'000, ' ') + "F")), "");
}

TEST(LsysLimits, localValues) {
    const auto with = [](int count) {
        return block("steps 1\naxiom A\nA : {" + numbered(count, " = 1; ", "v") + " = 1} * -> F");
    };
    EXPECT_EQ(said(with(256)).find("error"), std::string::npos);
    EXPECT_THAT(said(with(20'000)), HasSubstr("a production has at most 256 local values"));
}

TEST(LsysLimits, idleLocalValuesBesideManyVariables) {
    // Each looked for a name like its own among all variables, whether its warning was shown or not.
    std::string text = "steps 1\naxiom A\nvariable " + numbered(5000, " = 1, ", "c") + " = 1";
    for (int i = 0; i < 5000; ++i)
        text += fmt::format("\nA : {{q{0} = 1}} step > {0} -> F", i);
    const std::string messages = said(block(text));
    EXPECT_THAT(messages, HasSubstr("nothing reads the local value 'q0'"));
    EXPECT_EQ(messages.find("error"), std::string::npos);
}

TEST(LsysLimits, longChainsOfInterpretations) {
    // Ages were handed on by one production at a time, in as many rounds over all.
    constexpr int count = 30'000;
    std::string text = "modules " + numbered(count, " ", "m") + "\nsteps 0\naxiom F\ninterpret {";
    for (int i = 1; i < count; ++i)
        text += fmt::format("\nm{} -> m{}", i - 1, i);
    EXPECT_EQ(said(block(text + fmt::format("\nm{} : age > 1 -> F\n}}", count - 1))).find("error"),
              std::string::npos);
}

TEST(LsysLimits, anglesBeyondTheRange) {
    // Directions that are no numbers were never found among the known ones.
    EXPECT_THAT(said(block("steps 50\naxiom +(90)@B(1e308)A\nA -> [$A]$")),
                HasSubstr("an elasticity is at most 1e+100, not 1e+308"));
    EXPECT_THAT(said(block("angle 1e300\nsteps 0\naxiom @A(1e50)+F")),
                HasSubstr("the factor of the angle leaves the range of numbers"));
}

TEST(LsysLimits, polygonsOfManyCornersAreWork) {
    const auto work_of = [](int corners) {
        std::string text = "lsys test {\nsteps 0\naxiom {";
        for (int i = 0; i < corners; ++i)
            text += "f+(0.04)";
        StageWork work;
        LowerHelp help;
        help.control.work = &work;
        SourceMap sources;
        Diagnostics diagnostics;
        EXPECT_TRUE(lower_text("m.lsys", text + "}\n}\n", {}, sources, diagnostics, help).graph);
        return work.seconds();
    };
    EXPECT_GT(work_of(8000), 3 * work_of(4000)) << "its square";
}

TEST(LsysUses, PrimitivesDoNotNameUsedModels) {
    // `~sphere` placed the primitive, whatever the file was.
    EXPECT_EQ(said("use sphere = \"ball.rifs\"\nlsys a {\n  steps 0\n  axiom F ~sphere\n}\n"),
              "m.lsys:1:5: error: 'sphere' is a primitive and cannot name a used model\n"
              "    use sphere = \"ball.rifs\"\n"
              "        ^~~~~~\n");
}

TEST(LsysLimits, polygonsAtTheEndsOfTheRange) {
    // The squares of their areas are no doubles: they were left out.
    for (const char* step : {"1e90", "1e-90"}) {
        SourceMap sources;
        Diagnostics diagnostics;
        const auto graph =
            lower_text("m.lsys", block(fmt::format("step {}\nangle 90\nsteps 0\naxiom {{F+F+F+F}}", step)),
                       {}, sources, diagnostics)
                .graph;
        ASSERT_TRUE(graph) << diagnostics.render(sources);
        EXPECT_EQ(graph->objects[graph->root].instances.size(), 2u) << step;
    }
}

} // namespace
} // namespace graftal
