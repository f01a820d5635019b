// Published L-systems: how long their words are, and how often they draw.

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/lsys/words.h"

namespace graftal {
namespace {

struct Fixture {
    std::string name;
    std::string text;
    unsigned steps;
    std::size_t modules;  ///< 0: not published
    std::size_t segments; ///< F, and G, l, r where these draw
    std::string drawn = "F";
};

const std::string monopodial = R"(
modules A B C
axiom A(1, 10)
A(l,w) -> !(w)F(l)[&(a0)B(l*r2,w*wr)]/(137.5)A(l*r1,w*wr)
B(l,w) -> !(w)F(l)[-(a2)$C(l*r2,w*wr)]C(l*r1,w*wr)
C(l,w) -> !(w)F(l)[+(a2)$B(l*r2,w*wr)]B(l*r1,w*wr))";

const std::string sympodial = R"(
modules A B
axiom A(1, 10)
A(l,w) -> !(w)F(l)[&(a1)B(l*r1,w*wr)]/(180)[&(a2)B(l*r2,w*wr)]
B(l,w) -> !(w)F(l)[+(a1)$B(l*r1,w*wr)][-(a2)$B(l*r2,w*wr)])";

const std::string ternary = R"(
let d1 = 94.74, d2 = 132.63, a = 18.95, lr = 1.109, vr = 1.732
axiom !(1)F(200)/(45)A
A -> !(vr)F(50)[&(a)F(50)A]/(d1)[&(a)F(50)A]/(d2)[&(a)F(50)A]
F(l) -> F(l*lr)
!(w) -> !(w*vr))";

const std::string hilbert = R"(
modules A B C D
axiom A
A -> B-F+CFC+F-D&F^D-F+&&CFC+F+B//
B -> A&F^CFB^F^D^^-F-D^|F^B|FC^F^A//
C -> |D^|F^B-F+C^F^A&&FA&F^C+F+B^F^D//
D -> |CFB-F+B|FA&F^A&&FB-F+B|FC//)";

const std::string bush = R"(
axiom A
A -> [&FL!A]/////'[&FL!A]///////'[&FL!A]
F -> S/////F
S -> FL
L -> ['''^^{-f+f+f-|-f+f+f}])";

const std::string flowering_plant = R"(
modules plant internode seg leaf flower pedicel wedge
axiom plant
plant -> internode+[plant+flower]--//[--leaf]internode[++leaf]-[plant flower]++plant flower
internode -> F seg[//&&leaf][//^^leaf]F seg
seg -> seg F seg
leaf -> ['{+f-ff-f+|+f-ff-f}]
flower -> [&&&pedicel'/wedge////wedge////wedge////wedge////wedge]
pedicel -> FF
wedge -> ['^F][{&&&&-f+f|-f+f}])";

std::vector<Fixture> fixtures() {
    std::vector<Fixture> all = {
        {"1.3", "axiom b\nmodules a b\na -> ab\nb -> a", 10, 89, 0},
        {"1.6", "axiom F-F-F-F\nF -> F-F+F+FF-F-F+F", 3, 3803, 2048},
        {"1.7a", "axiom F-F-F-F\nF -> F+FF-FF-F-F+F+FF-F-F+F+FF+FF-F", 2, 2211, 1296},
        {"1.7b", "axiom -F\nF -> F+F-F-F+F", 4, 1250, 625},
        {"1.8", "axiom F+F+F+F\nF -> F+f-FF+F+FF+Ff+FF-f+FF-F-FF-Ff-FFF\nf -> ffffff", 2, 2595, 1296},
        {"1.10a", "axiom l\nmodules l r\nl -> l+r+\nr -> -l-r", 10, 3070, 1024, "lr"},
        {"1.10b", "axiom r\nmodules l r\nl -> r+l+r\nr -> l-r-l", 6, 1457, 729, "lr"},
        {"1.11a", "axiom L\nmodules L R\nL -> +RF-LFL-FR+\nR -> -LF+RFR+FL-", 5, 3411, 1023},
        {"1.19", hilbert, 2, 271, 63},
        {"1.24a", "axiom F\nF -> F[+F]F[-F]F", 5, 7811, 3125},
        {"1.24b", "axiom F\nF -> F[+F]F[-F][F]", 5, 9373, 3125},
        {"1.24c", "axiom F\nF -> FF-[-F+F+F]+[+F-F-F]", 4, 11116, 4096},
        {"1.24d", "axiom X\nX -> F[+X]F[-X]+X\nF -> FF", 7, 13956, 4118},
        {"1.24e", "axiom X\nX -> F[+X][-X]FX\nF -> FF", 7, 12863, 4118},
        {"1.24f", "axiom X\nX -> F-[[X]+X]+F[+FX]-X\nF -> FF", 5, 6263, 1488},
        {"1.25", bush, 7, 77399, 3891},
        {"1.26", flowering_plant, 5, 15325, 533},
        {"2.8a", ternary, 6, 0, 1457},
        {"snowflake", "axiom F--F--F\nF -> F+F--F+F", 4, 1792, 768},
        {"bushes", "axiom Y\nY -> YFX[+Y][-Y]\nX -> X[-FFF]F[+FFF]FX", 6, 8156, 2772},
    };
    for (const std::string constants :
         {"r1 = 0.9, r2 = 0.6, a0 = 45, a2 = 45", "r1 = 0.9, r2 = 0.9, a0 = 45, a2 = 45",
          "r1 = 0.9, r2 = 0.8, a0 = 45, a2 = 45", "r1 = 0.9, r2 = 0.7, a0 = 30, a2 = -30"})
        all.push_back({"2.6", "let wr = 0.707, " + constants + monopodial, 10, 0, 1023});
    for (const std::string constants :
         {"r1 = 0.9, r2 = 0.7, a1 = 5, a2 = 65", "r1 = 0.9, r2 = 0.7, a1 = 10, a2 = 60",
          "r1 = 0.9, r2 = 0.8, a1 = 20, a2 = 50", "r1 = 0.9, r2 = 0.8, a1 = 35, a2 = 35"})
        all.push_back({"2.7", "let wr = 0.707, " + constants + sympodial, 10, 0, 1023});
    return all;
}

TEST(LsysFixtures, wordsAreAsLongAsPublished) {
    for (const Fixture& fixture : fixtures()) {
        testing::LsysModel model(fixture.text);
        const auto word = model.derive(fixture.steps);
        ASSERT_TRUE(word) << fixture.name << model.errors();
        EXPECT_EQ(fixture.modules > 0 ? word->size() : 0, fixture.modules) << fixture.name;
        const auto segments = std::ranges::count_if(*word, [&](ModuleId module) {
            return fixture.drawn.find(model.symbol(module)) != std::string::npos;
        });
        EXPECT_EQ(segments, static_cast<std::ptrdiff_t>(fixture.segments)) << fixture.name;
    }
}

TEST(LsysFixtures, anabaenaOfAbopEquation11) {
    // Capitals are cells that point to the right.
    const std::string text = "modules a b A B\naxiom A\nA -> aB\na -> bA\nB -> A\nb -> a";
    const std::vector<std::string> words = {"A", "aB", "bAA", "aaBaB", "bAbAAbAA"};
    for (unsigned step = 0; step < words.size(); ++step)
        EXPECT_EQ(testing::derived(text, step), words[step]);
}

TEST(LsysFixtures, parametricWordOfAbopSection110) {
    const std::string text = R"(
modules A B C
axiom B(2)A(4,4)
A(x,y) : y <= 3 -> A(x*2, x+y)
A(x,y) : y > 3 -> B(x)A(x/y, 0)
B(x) : x < 1 -> C
B(x) : x >= 1 -> B(x-1))";
    const std::vector<std::string> words = {"B(2)A(4,4)", "B(1)B(4)A(1,0)", "B(0)B(3)A(2,1)", "CB(2)A(4,3)",
                                            "CB(1)A(8,7)"};
    for (unsigned step = 0; step < words.size(); ++step)
        EXPECT_EQ(testing::derived(text, step), words[step]);
}

} // namespace
} // namespace graftal
