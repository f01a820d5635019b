#include "compiler/lsys/compose/sizes.h"

#include <cmath>
#include <random>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/lsys/turtle.h"

namespace graftal {
namespace {

using testing::CompiledLsys;
using testing::Figure;
using testing::LsysModel;
using testing::plain_figure;
using testing::Stroke;
using testing::Unfolding;

/// The roles of a module's parameters, a letter each.
std::string roles_of(const std::string& statements, const std::string& symbol, std::size_t arity) {
    LsysModel model(statements);
    const LsysGrammar& grammar = model.rewriter().grammar();
    const LsysSizes sizes(grammar, {});
    const auto id = std::ranges::find(grammar.symbols, symbol) - grammar.symbols.begin();
    std::string letters;
    for (const ParameterRole role : sizes.roles(static_cast<SymbolId>(id), arity))
        letters += "nlw"[static_cast<int>(role)];
    return letters;
}

TEST(LsysSizes, rolesOfParameters) {
    const struct {
        const char* text;
        const char* roles;
    } cases[] = {
        {"axiom A(1)\nA(s) -> F(s)A(s*0.9)", "l"},
        {"axiom A(1)\nA(s) -> F(s/3)[A(s*random(0.5,0.7))]", "l"},
        {"axiom A(1)\nA(s) -> F(s+1)A(s*0.9)", "n"},
        {"axiom A(1)\nA(s) : s > 0.1 -> F(s)A(s*0.9)", "n"},
        {"axiom A(1)\nA(s) : s > 0 -> F(s)A(s*0.9)", "l"},
        {"axiom A(1)\nA(s) -> +(s)F(s)A(s*0.9)", "n"},
        {"axiom A(1)\nA(s) -> F(s):s/2\nA(s) -> F:1-s/2", "n"},
        {"axiom A(1,2)\nA(l,w) -> !(w)F(l)A(l*0.9,w*0.7)", "lw"},
        {"axiom A(1,2)\nA(l,w) -> !(w)F(w)A(l*0.9,w*0.7)", "wl"}, // l is drawn nowhere
        {"axiom A(1,2)\nA(l,w) -> !(w)F(l)A(w*0.9,l)", "ll"},
        {"axiom A(1,2)\nA(l,w) : l > 3*w -> !(w)F(l)A(l*0.9,w*0.7)", "ll"},
        {"axiom A(1,2)\nA(l,w) -> !(sqrt(w*w+w*w))F(l)A(l,w)", "ll"},
        {"axiom A(1,2)\nA(l,n) -> F(l*n)A(l*0.9,n+1)", "ln"},
        {"axiom A(1,2)\nA(n,l) -> F(l*n)A(n+1,l*0.9)", "nl"},
        {"axiom A(1,2)\nA(l,k) -> F(l*k)A(l*0.9,k*0.8)", "ln"}, // one of both has to be
        {"axiom A(1,2)\nA(a,b) -> F(a)F(b)A(a*0.9,2)", "ln"},   // a length of its own beside one that comes
    };
    for (const auto& c : cases)
        EXPECT_EQ(roles_of(c.text, "A", std::string(c.roles).size()), c.roles) << c.text;
}

struct Case {
    const char* name;
    std::string text;
    unsigned steps;
};

/// Sizes of many kinds, and whatever else a turtle has.
std::vector<Case> models() {
    return {
        {"constant width",
         "width 0.1\nangle 25\naxiom X(1)\nX(s) -> F(s)[+X(s*0.83)]F(s*0.97)[-X(s*0.79)]X(s*0.53)", 6},
        {"widths by parameters",
         "angle 25\naxiom X(1,0.2)\nX(s,w) -> !(w)F(s)[+X(s*0.83,w*0.6)][-X(s*0.61,w*0.7)]X(s*0.53,w*0.4)",
         6},
        {"widths by themselves",
         "width 0.1\naxiom X(1)\nX(s) -> F(s)![+(20)X(s*0.83)]F(s)[-(30)X(s*0.7)]!X(s*0.6)", 6},
        {"widths that productions change",
         "width 0.1\naxiom X(1)\nX(s) -> !(0.2)F(s)[+(20)X(s*0.8)][-(30)X(s*0.7)]&(10)X(s*0.6)\n"
         "!(w) -> !(w*1.3)",
         6},
        {"lengths of their own",
         "width 0.1\nangle 40\naxiom X(1)\nX(s) -> F(s)[+FL]F(0.2)[-X(s*0.8)][+X(s*0.7)]B(2)X(s*0.6)\n"
         "B(t) -> [&F(t)B(t*0.5)]\nL -> [+F(0.1)][-F(0.1)]",
         5},
        {"tropism",
         "width 0.1\ntropism 0.2,-1,0\naxiom T(0.2)X(1)\n"
         "X(s) -> F(s)[+(20)X(s*0.83)]F(s)[&(30)X(s*0.7)]/(90)X(s*0.6)",
         5},
        {"two lengths",
         "width 0.1\naxiom X(1,2)\nX(s,t) -> F(s)[+(20)X(t*0.4,s*0.7)]F(t)[&(30)X(s*0.6,t*0.5)]", 6},
        {"colours, negative lengths and zeros",
         "width 0.1\naxiom X(1)\nX(s) -> ;F(s)[+(20)X(0-s*0.83)][-(20)X(s*0.7)];(2)F(s-s)X(s*0.6)", 6},
        {"numbers beside sizes",
         "width 0.1\naxiom X(1,0)\nX(s,n) : n < 3 -> F(s)[+(20+n)X(s*0.8,n+1)][-(30)X(s*0.7,n+1)]\n"
         "X(s,n) -> F(s/2)[-(n)X(s*0.9,0)]X(s*0.5,1)",
         6},
    };
}

/// Off by no more than the bound that is stated, wherever it is.
void expect_within(const Figure& wanted, const CompiledLsys& compiled, const std::string& what) {
    const Unfolding found(compiled.graph);
    ASSERT_EQ(found.strokes.size(), wanted.strokes.size()) << what;
    double size = 1, worst = 0;
    for (std::size_t i = 0; i < wanted.strokes.size(); ++i) {
        const Stroke& a = wanted.strokes[i];
        const Stroke& b = found.strokes[i];
        size = std::max(size, glm::length(a.to));
        worst = std::max({worst, glm::distance(a.from, b.from) + std::abs(a.width - b.width) / 2,
                          glm::distance(a.to, b.to) + std::abs(a.width - b.width) / 2});
    }
    EXPECT_LE(worst, compiled.derivation->error + 1e-9 * size) << what;
    EXPECT_EQ(compiled.derivation->modules, std::to_string(wanted.modules)) << what;
}

TEST(LsysSizes, roundedModelsStayWithinTheirBound) {
    bool resized = false, rounded = false;
    for (const Case& model : models()) {
        const Figure wanted = plain_figure(model.text, model.steps, 0.1);
        const std::size_t all = CompiledLsys(model.text, model.steps).derivation->parts;
        for (std::size_t most = all; most > all / 20; most = 9 * most / 10) {
            LowerOptions options;
            options.max_objects = most;
            SourceMap sources;
            Diagnostics diagnostics;
            const std::string text = "lsys m {\n" + model.text + "\n}\n";
            options.steps = model.steps;
            if (!lower_text("m.lsys", text, options, sources, diagnostics).graph) break; // it is too few
            const CompiledLsys compiled(model.text, model.steps, options);
            expect_within(wanted, compiled, fmt::format("{} in {} parts", model.name, most));
            resized |= compiled.derivation->parts < all;
            rounded |= compiled.derivation->size_step > 0;
        }
    }
    EXPECT_TRUE(resized);
    EXPECT_TRUE(rounded);
}

TEST(LsysSizes, partsGrowWithTheRangeOfSizes) {
    const std::string many = "angle 25\naxiom X(1)\n"
                             "X(s) -> F(s)[+X(s*0.83)]F(s*0.97)[-X(s*0.79)][+X(s*0.71)]F(s*0.9)[-X(s*0.61)]"
                             "X(s*0.53)";
    const CompiledLsys model(many, 30); // 324,632 sizes
    EXPECT_LE(model.derivation->parts, 4'096u);
    EXPECT_GT(model.derivation->error, 0);
    EXPECT_LT(model.derivation->error, 0.05);
    EXPECT_EQ(model.derivation->segments, "698491930961608886718"); // 3 (5^30 - 1) / 4
}

TEST(LsysSizes, sizesThatChangeNothingElseAreOnePart) {
    // The widths go with the lengths: nothing is rounded, whatever the number of sizes.
    const CompiledLsys model("angle 25\naxiom X(1)\nX(s) -> !(s/9)F(s)[+X(s*0.83)][-X(s*0.79)][+X(s*0.71)]"
                             "[-X(s*0.61)]X(s*0.53)",
                             40);
    EXPECT_LE(model.derivation->parts, 200u);
    EXPECT_EQ(model.derivation->error, 0);
}

TEST(LsysSizes, fewPartsAreLeftAsTheyAre) {
    const CompiledLsys model("angle 25\naxiom X(1)\nX(s) -> F(s)[+X(s*0.83)][-X(s*0.79)]X(s*0.53)", 12);
    EXPECT_EQ(model.derivation->error, 0);
    EXPECT_EQ(model.derivation->size_step, 0);
}

} // namespace
} // namespace graftal
