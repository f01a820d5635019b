// Models with variables and local blocks are composed, and give the figure of the word that is derived module
// by module.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/lsys/turtle.h"

namespace graftal {
namespace {

using testing::CompiledLsys;
using ::testing::HasSubstr;
using testing::Stroke;

std::vector<Stroke> sorted_strokes(const CompiledLsys& model) {
    std::vector<Stroke> strokes = testing::Unfolding(model.graph).strokes;
    std::ranges::sort(strokes, {}, [](const Stroke& s) {
        const auto round = [](double x) { return std::round(x * 1e6); };
        return std::array{round(s.from.x), round(s.from.y), round(s.from.z),
                          round(s.to.x),   round(s.to.y),   round(s.to.z)};
    });
    return strokes;
}

void expect_composed_as_derived(const std::string& statements, unsigned steps) {
    const std::string text = "angle 25\nwidth 0.1\n" + statements;
    const CompiledLsys composed(text, steps);
    const CompiledLsys derived(text, steps, {.exact = true});
    EXPECT_EQ(composed.derivation->way, "composed") << statements;
    EXPECT_EQ(derived.derivation->way, "derived") << statements;
    EXPECT_EQ(composed.derivation->modules, derived.derivation->modules) << statements;
    const std::vector<Stroke> a = sorted_strokes(composed), b = sorted_strokes(derived);
    ASSERT_EQ(a.size(), b.size()) << statements;
    ASSERT_GT(a.size(), 1u) << statements;
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_LT(glm::length(a[i].from - b[i].from), 1e-5) << statements;
        EXPECT_LT(glm::length(a[i].to - b[i].to), 1e-5) << statements;
        EXPECT_NEAR(a[i].width, b[i].width, 1e-6) << statements;
    }
}

TEST(LsysBlocks, composedAndDerivedAgree) {
    const std::string counts = "modules A B C\nvariable n = 0, m = 1\narray a[3] = 20, 30, 40\n"
                               "start { m = 2; a[1] = 35 }\nstart each { n = (n + 1) % 3 }\n"
                               "end each { m = m * 0.8 }\nend { n = 2 }\n";
    for (const char* const productions : {
             "axiom A\nA -> F(m)[+(a[n])A][-(a[2-n])A]",
             "axiom A(m)\nA(x) : x > m/4 -> F(x)[+A(0.7*x)]A(0.8*x)",
             "axiom A(1)\nA(x) : { y = 0.7 * x } y > 0.1 { z = 0.9 * y } -> F(x)[+A(y)][-A(z)]",
             "axiom A(1)\nA(x) : n == 2 { x = x/2; if (x < 0.2) { x = 0.3 } } -> F(x)[+A(x)]A(x)",
             "axiom A\nA -> B[+A]A\ninterpret B : * { y = m + n } -> F(y)",
             "axiom A(4)\nA(x) -> B(x)[+A(x-1)]A(x-1)\ndecompose B(x) : x > 0 { x = x - 1 } -> F(m)B(x)",
             "axiom A\nA : age == n -> F[+A][-A]F(m)",
             "axiom A(1)\nA(x) : * { i = 0; y = 0; while (i < 3) { y = y + a[i]; i = i + 1 } } -> "
             "F(x)+(y)A(x)[-A(x)]",
         })
        expect_composed_as_derived(counts + productions, 5);
}

TEST(LsysBlocks, whatTheSizeIsBlocksMayAsk) {
    // Without a block these are one part in all sizes.
    const std::string rules =
        "axiom A(1)\nA(x) : * { y = x; if (y > 0.5) { y = 0.9*y } } -> F(x)[+A(0.7*y)]A(0.6*y)";
    expect_composed_as_derived(rules, 8);
}

TEST(LsysBlocks, chanceInTheSecondBlockIsComposed) {
    const CompiledLsys model("seed 2\naxiom A\nA : * { x = random(1, 2) } -> F(x)[+A]A", 6);
    EXPECT_EQ(model.derivation->way, "composed");
    EXPECT_GE(model.derivation->variants, 64u);
    const CompiledLsys drawn("seed 2\naxiom A\nA -> A B\ninterpret B : * { x = normal(1, 0.1) } -> F(x)", 6);
    EXPECT_EQ(drawn.derivation->way, "composed");
    EXPECT_EQ(drawn.derivation->segments, "6");
}

TEST(LsysBlocks, theLastBlockIsSeenByTheDrawing) {
    for (const char* const block : {"", ": * { m = m + 1 }"}) {
        const CompiledLsys model(
            fmt::format("width 0.1\nvariable n = 1, m = 0\nend {{ n = 7 }}\naxiom A\nA {} -> A F(0.5)\n"
                        "interpret A -> F(n)",
                        block),
            2);
        double longest = 0;
        for (const Stroke& stroke : testing::Unfolding(model.graph).strokes)
            longest = std::max(longest, glm::length(stroke.to - stroke.from));
        EXPECT_NEAR(longest, 7, 1e-9) << block;
    }
}

TEST(LsysBlocks, setReplacesFirstValues) {
    LowerOptions options;
    options.set["n"] = 3;
    const CompiledLsys model("variable n = 1\naxiom F(n)\nstart { n = 2*n }\n", 0, options);
    double longest = 0;
    for (const Stroke& stroke : testing::Unfolding(model.graph).strokes)
        longest = std::max(longest, glm::length(stroke.to - stroke.from));
    EXPECT_NEAR(longest, 6, 1e-9);
    options.set["m"] = 3;
    try {
        CompiledLsys("variable n = 1\naxiom F(n)\n", 0, options);
        FAIL() << "an unknown name was set";
    } catch (const std::runtime_error& error) {
        EXPECT_THAT(error.what(), HasSubstr("known here: n"));
    }
}

TEST(LsysBlocks, noLimit) {
    for (const auto& [productions, obstacle] :
         {std::pair("A : { x = 2 } -> F(x)A", "with blocks"),
          std::pair("A F -> F A F", "rewrite several modules"),
          std::pair("A -> F(n)A\nend each { n = n/2 }", "read variables")}) {
        SourceMap sources;
        Diagnostics diagnostics;
        lower_text("m.lsys",
                   fmt::format("lsys m {{\nsteps infinite\nvariable n = 1\naxiom A F\n{}\n}}\n", productions),
                   {}, sources, diagnostics);
        EXPECT_THAT(diagnostics.render(sources), HasSubstr(obstacle));
    }
}

} // namespace
} // namespace graftal
