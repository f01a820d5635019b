// What symbols multiply and brackets restore, a second pair of axes, mirrored turns: composed parts draw what
// the word draws module by module.

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/unit/lsys/turtle.h"

namespace graftal::testing {
namespace {

std::vector<Stroke> strokes_of(const std::string& statements, unsigned steps, bool exact) {
    LowerOptions options;
    options.exact = exact;
    const CompiledLsys model(statements, steps, options);
    std::vector<Stroke> strokes = Unfolding(model.graph).strokes;
    const auto key = [](const Stroke& s) {
        const auto round = [](double x) { return std::round(x * 1e6); };
        return std::array{round(s.from.x), round(s.from.y), round(s.from.z),
                          round(s.to.x),   round(s.to.y),   round(s.to.z)};
    };
    std::ranges::sort(strokes, {}, key);
    return strokes;
}

void expect_one_figure(const std::string& statements, unsigned steps) {
    const std::vector<Stroke> composed = strokes_of(statements, steps, false),
                              derived = strokes_of(statements, steps, true);
    ASSERT_EQ(composed.size(), derived.size()) << statements;
    ASSERT_GT(composed.size(), 10u) << statements;
    for (std::size_t i = 0; i < composed.size(); ++i) {
        EXPECT_LT(glm::length(composed[i].from - derived[i].from), 1e-5) << statements;
        EXPECT_LT(glm::length(composed[i].to - derived[i].to), 1e-5) << statements;
        EXPECT_NEAR(composed[i].width, derived[i].width, 1e-6) << statements;
    }
}

TEST(TurtleState, ComposedAndDerivedAgree) {
    for (const char* productions :
         {"A -> F[@Di(0.7)+A]@S(0.9)[-(20)A]F(0.3)", "A -> F!(0.1)[@Di(0.5)!(0.2)+A]@W(0.8)[@Dd(1.2)-A]",
          "A -> F[@A(0.8)+A]@A(1.1)[-A]&F", "A -> F@X+(30)F@X[@F+A][-A]@X/(20)F@X",
          "A -> F[@N+A][@N(1)-A]^F@F/(40)F[&A]", "A -> F[$@B(0.3)+A]&(40)@B(0.2)[/A]F",
          "A -> {.f.+f.[@E-A].}@S(0.8)A"})
        expect_one_figure(std::string("angle 25\nwidth 0.3\naxiom A\n") + productions, 5);
    expect_one_figure("angle 25\nthickness 0.2\nthinnest 0.03\naxiom A\nA -> F[@S(0.7)+A]!(0.1)[@S(0.6)-A]@O",
                      6);
}

TEST(TurtleState, ASimilarityFoldsWhateverItsDepth) {
    const CompiledLsys tree("angle 25\nthickness 0.1\naxiom A\nA -> F[@Di(0.7)+A][@Di(0.6)-A]", 200);
    EXPECT_LT(tree.derivation->parts, 300u) << "one for each step";
}

TEST(TurtleState, FactorsKeepToTheRangeOfNumbers) {
    SourceMap sources;
    for (const char* axiom : {"@Di(0)F", "@S(-1)F", "@Di(1e99)@Di(1e99)F", "@A(1e99)@A(1e99)F", "@W(-2)F"}) {
        Diagnostics diagnostics;
        lower_text("m.lsys", std::string("lsys m {\nsteps 0\naxiom ") + axiom + "\n}\n", {}, sources,
                   diagnostics);
        EXPECT_TRUE(diagnostics.has_errors()) << axiom;
    }
}

TEST(LocalValues, StandForWhatTheySay) {
    const CompiledLsys model("table t = 0, 2, 4\naxiom A(4)\n"
                             "A(x) : y > 0.4 with y = x/2, z = t(y/2) + choose(y == 0, 1/y, 1) -> F(z)A(y)",
                             8);
    EXPECT_EQ(model.derivation->segments, "3"); // y: 2, 1, 0.5, then 0.25
    const std::vector<Stroke> strokes = Unfolding(model.graph).strokes;
    EXPECT_NEAR(strokes.front().to.y, 5, 1e-9);
}

TEST(LocalValues, AreRefusedWhereTheyAreRandomOrTooLong) {
    const auto said = [](const std::string& production) {
        SourceMap sources;
        Diagnostics diagnostics;
        lower_text("m.lsys", "lsys m {\nsteps 1\naxiom A(1)\n" + production + "\n}\n", {}, sources,
                   diagnostics);
        return diagnostics.render(sources);
    };
    EXPECT_NE(said("A(x) : * with y = random(0, 1) -> F(y)").find("must not be random"), std::string::npos);
    std::string doubling = "A(x) : * with a0 = x";
    for (int i = 1; i < 40; ++i)
        doubling +=
            ", a" + std::to_string(i) + " = a" + std::to_string(i - 1) + " + a" + std::to_string(i - 1);
    EXPECT_NE(said(doubling + " -> F(a39)").find("too long an expression"), std::string::npos);
    EXPECT_NE(said("A(x) : x > 1 with -> F").find("the name of a local value"), std::string::npos);
}

} // namespace
} // namespace graftal::testing
