// Variables, the blocks of steps and those of productions: values, what is composed, and what is derived in
// order.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/lsys/words.h"

namespace graftal {
namespace {

using testing::derived;
using ::testing::HasSubstr;

const std::string modules = "modules A B C D L\n";

TEST(LsysVariables, areReadEverywhere) {
    EXPECT_EQ(derived(modules + "variable n = 2, m = 3\naxiom A(n)B\nA(x) : x == n -> C(x+m)", 1), "C(5)B");
    EXPECT_EQ(derived(modules + "variable n = 2\naxiom A(1)\ndecompose A(x) -> B(x+n)", 0), "B(3)");
    EXPECT_EQ(derived(modules + "let k = 4\nvariable n = k/2\naxiom A(n)", 0), "A(2)");
}

TEST(LsysVariables, blocksOfStepsChangeThem) {
    const std::string model = modules + "variable n = 1\nstart { n = 10 }\nstart each { n = n + 1 }\n"
                                        "end each { n = n * 2 }\naxiom A(n)\nA(x) -> A(x)B(n)\n";
    EXPECT_EQ(derived(model, 0), "A(10)");
    EXPECT_EQ(derived(model, 1), "A(10)B(11)");
    EXPECT_EQ(derived(model, 2), "A(10)B(23)B(11)");
    EXPECT_EQ(derived(model, 3), "A(10)B(47)B(23)B(11)");
}

TEST(LsysVariables, aStepMayWaitForThem) {
    EXPECT_EQ(derived(modules + "variable n = 0\nend each { n = n + 1 }\naxiom A\nA : n >= 5 -> B(n)", 5),
              "A");
    EXPECT_EQ(derived(modules + "variable n = 0\nend each { n = n + 1 }\naxiom A\nA : n >= 5 -> B(n)", 9),
              "B(5)");
}

TEST(LsysVariables, contextsSeeThem) {
    const std::string model = modules + "variable n = 0\nstart each { n = step * step }\naxiom A B\n"
                                        "A < B : n < 10 -> B C(n)\n";
    EXPECT_EQ(derived(model, 5), "ABC(9)C(4)C(1)");
}

TEST(LsysVariables, arraysHaveOneIndexOrTwo) {
    EXPECT_EQ(derived(modules + "array a[3] = 5, 6, 7\naxiom A(a[0])A(a[1.5])A(a[2])", 0), "A(5)A(6)A(7)");
    EXPECT_EQ(
        derived(modules + "let n = 2\narray a[n][3] = 1, 2, 3,\n  4, 5, 6\naxiom A(a[1][0])A(a[0][n])", 0),
        "A(4)A(3)");
    EXPECT_EQ(
        derived(modules + "array a[4]\nstart { a[1] = 8; a[a[1]-5] = 9 }\naxiom A(a[0])A(a[1])A(a[3])", 0),
        "A(0)A(8)A(9)");
    EXPECT_EQ(derived(modules + "array a[2][2]\nstart each { a[step % 2][1] = step }\naxiom A\n"
                                "A -> A B(a[0][1],a[1][1])",
                      3),
              "AB(2,3)B(2,1)B(0,1)");
}

TEST(LsysVariables, statementsOfBlocks) {
    const auto after = [](const std::string& block) {
        return derived(modules + "variable x = 0, y = 0\nstart {" + block + "}\naxiom A(x)", 0);
    };
    EXPECT_EQ(after("if (1) { x = 1 } else { x = 2 }"), "A(1)");
    EXPECT_EQ(after("if (0) { x = 1 } else { x = 2 }"), "A(2)");
    EXPECT_EQ(after("if (0) { x = 1 } else if (y == 0) { x = 2 } else { x = 3 }"), "A(2)");
    EXPECT_EQ(after("if (0) { x = 1 } else if (0) { x = 2 } else { x = 3 }"), "A(3)");
    EXPECT_EQ(after("while (x < 10) { x = x + 3; }"), "A(12)");
    EXPECT_EQ(after("x = 100; do { x = x + 3 } while (x < 10)"), "A(103)");
    EXPECT_EQ(after("do { x = x + 3; y = y + x } while (x < 10); x = y"), "A(30)");
    EXPECT_EQ(after("\n  x = 4 // a remark; with words\n  y = x /* and {more} */ + 1\n x = y\n"), "A(5)");
    EXPECT_EQ(after("x = step; ;; "), "A(0)");
    EXPECT_EQ(after(""), "A(0)");
    EXPECT_EQ(after("while (y < 5) { y = y + 1; if (y % 2 == 0) { x = x + y } }"), "A(6)");
}

TEST(LsysVariables, hideNamesOfTheFileAndAreHidden) {
    EXPECT_EQ(derived(modules + "variable n = 2\naxiom A(7)\nA(n) -> B(n)", 1), "B(7)");
    EXPECT_EQ(derived(modules + "variable n = 2\nend each { n = 3 }\naxiom A(7)\nA(n) -> B(n)A(n)", 2),
              "B(7)B(7)A(7)");
}

TEST(LsysVariables, localBlocksOfProductions) {
    EXPECT_EQ(derived(modules + "axiom A(2)\nA(x) : { y = x * x } y > 3 { z = y + 1 } -> B(x,y,z)", 1),
              "B(2,4,5)");
    EXPECT_EQ(derived(modules + "axiom A(1)\nA(x) : { y = x * x } y > 3 -> B", 1), "A(1)");
    EXPECT_EQ(derived(modules + "axiom A(1)\nA(x) : { x = x + 5 } x > 3 -> B(x)", 1), "B(6)");
    EXPECT_EQ(derived(modules + "axiom A(1)\nA(x) : * { x = x + 5 } -> B(x)", 1), "B(6)");
    EXPECT_EQ(derived(modules + "axiom A(1)\nA(x) : { x = x + 5 } -> B(x)", 1), "B(6)");
    EXPECT_EQ(derived(modules + "axiom A(1)\nA(x) : x > 0 { if (x > 1) { y = 7 } } -> B(y)", 1), "B(0)");
    EXPECT_EQ(derived(modules +
                          "axiom A(9)\nA(x) :\n  {\n    y = x  # root\n    while (y > 2) { y = y / 2 }\n"
                          "    angle = y\n  }\n  1 < angle\n  { z = angle }\n  -> B(z)",
                      1),
              "B(1.125)");
}

TEST(LsysVariables, localBlocksCompeteAndDecompose) {
    EXPECT_EQ(
        derived(modules + "axiom A(4)\nA(x) : { p = x/4 } -> B : p\nA(x) : { q = 1 - x/4 } -> C : q", 1),
        "B");
    EXPECT_EQ(derived(modules + "axiom A(3)\ndecompose A(x) : x > 0 { y = x - 1 } -> B(y)A(y)", 0),
              "B(2)B(1)B(0)A(0)");
}

TEST(LsysVariables, productionsChangeThemInOrder) {
    const std::string count = modules + "variable n = 0\naxiom A A A\nA : { n = n + 1 } -> B(n)";
    EXPECT_EQ(derived(count, 1), "B(1)B(2)B(3)");
    EXPECT_EQ(
        derived(modules + "variable n = 0\naxiom A A A A\nA : n < 2 { n = n + 1 } -> B(n)\nA -> C(n)", 1),
        "B(1)B(2)C(2)C(2)");
    // The first block is carried out whenever the production is tried.
    EXPECT_EQ(derived(modules + "variable n = 0\naxiom A A A\nA : { n = n + 1 } n > 2 -> B(n)\nA -> C(n)", 1),
              "C(1)C(2)B(3)");
    EXPECT_EQ(
        derived(modules + "variable n = 0\nstart each { n = 0 }\naxiom A\nA : * { n = n + 1 } -> A B(n) A",
                2),
        "AB(1)AB(1)AB(2)A");
}

TEST(LsysVariables, orderedDerivationsDoAllThatOthersDo) {
    // Each successor is decomposed at once.
    EXPECT_EQ(
        derived(modules + "variable n = 0\naxiom A A\nA -> B\ndecompose B : * { n = n + 1 } -> C(n)L", 1),
        "C(1)LC(2)L");
    EXPECT_EQ(derived(modules + "variable n = 0\naxiom A B C\nA < B > C : * { n = n + 1 } -> D(n)", 1),
              "AD(1)C");
    EXPECT_EQ(derived(modules + "variable n = 0\naxiom A B C\nA B : * { n = n + 1 } -> D(n)", 1), "D(1)C");
    EXPECT_EQ(derived(modules + "variable n = 0\naxiom A[A B]A\nA : * { n = n + 1 } -> %", 1), "%");
    EXPECT_EQ(derived(modules + "variable n = 0\naxiom A\nA : age == 3 { n = n + 1 } -> B(n,age)", 3),
              "B(1,3)");
    EXPECT_EQ(
        derived(modules + "array a[3]\naxiom A(0)A(1)A(2)A(1)\nA(i) : * { a[i] = a[i] + 1 } -> B(a[i])", 1),
        "B(1)B(1)B(1)B(2)");
    EXPECT_EQ(derived(modules + "variable n = 0\naxiom A\nA : * { n = n + 1 } -> A\nend { n = 100 }\n"
                                "end each { n = n * 2 }",
                      3),
              "A");
}

TEST(LsysVariables, anOrderedWordIsThatOfThePureModel) {
    // `n` is written and never read, so that only the way of derivation differs.
    const std::string rules = "A(x) : x > 0 {} -> B[+A(x-1)]C A(x-2) B\n"
                              "B < C > A(x) : x > 1 -> C C\nB C -> D\n"
                              "decompose D -> B L\n";
    const std::string plain = modules + "ignore +\naxiom A(6)\n" + rules;
    std::string ordered = plain;
    ordered.replace(ordered.find("{}"), 2, "{ n = n + 1 }");
    for (unsigned steps = 0; steps < 7; ++steps)
        EXPECT_EQ(derived("variable n = 0\n" + ordered, steps), derived(plain, steps)) << steps;
}

TEST(LsysVariables, chanceInOrder) {
    const std::string model = modules + "variable n = 0\naxiom A A A A A A A A\n"
                                        "A : { n = random(0, 1) } n < 0.5 -> B\nA -> C";
    const std::string word = derived(model, 1, 7);
    EXPECT_EQ(word, derived(model, 1, 7));
    EXPECT_NE(word, derived(model, 1, 8));
    std::size_t heads = 0;
    for (std::uint64_t seed = 0; seed < 500; ++seed)
        for (const char c : derived(model, 1, seed))
            heads += c == 'B';
    EXPECT_NEAR(static_cast<double>(heads), 2000, 4 * 32);
}

TEST(LsysVariables, chanceInConditions) {
    const std::string model = modules + "axiom A A A A\nA : random(0, 1) < 0.25 -> B\nA -> C";
    std::size_t heads = 0;
    for (std::uint64_t seed = 0; seed < 1000; ++seed)
        for (const char c : derived(model, 1, seed))
            heads += c == 'B';
    EXPECT_NEAR(static_cast<double>(heads), 1000, 4 * 28);
}

TEST(LsysVariables, chanceInLoopsIsDrawnEachTime) {
    const std::string word =
        derived(modules + "axiom A\nA : * { i = 0\n x = 0\n y = 0\n"
                          "  while (i < 50) { z = random(0, 1); i = i + 1\n"
                          "    if (z < 0.5) { x = x + 1 } else { y = y + 1 } } } -> B(x,y)",
                1, 3);
    double x = 0, y = 0;
    ASSERT_EQ(std::sscanf(word.c_str(), "B(%lf,%lf)", &x, &y), 2) << word;
    EXPECT_EQ(x + y, 50);
    EXPECT_NEAR(x, 25, 4 * 3.6);
}

TEST(LsysVariables, chanceInBlocksOfSteps) {
    const std::string model =
        modules + "variable x = 0\nstart each { x = random(0, 1) }\naxiom A\nA -> A B(x)";
    EXPECT_EQ(derived(model, 3, 5), derived(model, 3, 5));
    EXPECT_NE(derived(model, 3, 5), derived(model, 3, 6));
}

TEST(LsysVariables, errorsAtTheirPlaces) {
    const auto of = [](const std::string& statements, unsigned steps = 1) {
        return derived(modules + statements, steps);
    };
    EXPECT_THAT(of("array a[3] = 1, 2, 3\naxiom A(3)\nA(i) -> B(a[i])"),
                HasSubstr("this index of 'a' must lie between 0 and 2, but is 3"));
    EXPECT_THAT(of("array a[3]\nstart { a[-1] = 2 }\naxiom A"), HasSubstr("between 0 and 2, but is -1"));
    EXPECT_THAT(of("variable n = 0\nstart { while (1) { n = n + 1 } }\naxiom A"),
                HasSubstr("more than 100000 statements"));
    EXPECT_THAT(of("variable n = 1\nstart each { n = 1/(n-1) }\naxiom A"), HasSubstr("division by zero"));
    EXPECT_THAT(of("variable n = 0\nstart { m = 1 }\naxiom A"), HasSubstr("declare it: variable m = 0"));
    EXPECT_THAT(of("let m = 0\nvariable n = 0\nstart { m = 1 }\naxiom A"), HasSubstr("'m' is a constant"));
    EXPECT_THAT(of("variable n = 0\nangle n\naxiom A"),
                HasSubstr("'n' is a variable, and 'angle' has one value"));
    EXPECT_THAT(of("variable n = 0, n = 1\naxiom A"), HasSubstr("duplicate name 'n'"));
    EXPECT_THAT(of("array a[2] = 1\naxiom A"), HasSubstr("'a' has 2 elements, but 1 values"));
    EXPECT_THAT(of("array a[0]\naxiom A"), HasSubstr("a whole number from 1"));
    EXPECT_THAT(of("array a[256][257]\naxiom A"), HasSubstr("more than 65536 numbers"));
    EXPECT_THAT(of("array a[2]\naxiom A(a)"), HasSubstr("'a' is an array"));
    EXPECT_THAT(of("array a[2]\naxiom A(a[1][1])"), HasSubstr("'a' has 1 index, not 2"));
    EXPECT_THAT(of("axiom A(b[1])"), HasSubstr("unknown array 'b'"));
    EXPECT_THAT(of("variable n = 0\naxiom A\ninterpret A : * { n = 1 } -> F"),
                HasSubstr("cannot change the variable"));
    EXPECT_THAT(of("axiom A\ninterpret A : { x = random(0,1) } x > 0 -> F"),
                HasSubstr("chance does not decide"));
    EXPECT_THAT(of("axiom A\nA : { x = 1 } x > 0 with y = 2 -> B(y)"), HasSubstr("either 'with' or blocks"));
    EXPECT_THAT(of("start { }\nstart { }\naxiom A"), HasSubstr("duplicate 'start'"));
    EXPECT_THAT(of("variable n = 0\nstart { n++ }\naxiom A"), HasSubstr("write n = n + 1"));
    EXPECT_THAT(of("variable n = 0\nstart { n += 2 }\naxiom A"), HasSubstr("write n = n + ..."));
    EXPECT_THAT(of("variable n = 0\nstart { if (n = 0) { n = 1 } }\naxiom A"),
                HasSubstr("write equality as =="));
    EXPECT_THAT(of("variable n = 0\nstart { if (n) n = 1 }\naxiom A"), HasSubstr("braces even around one"));
    EXPECT_THAT(of("axiom A\nA(x) : { y = x -> B"), HasSubstr("this '{' is not closed"));
}

TEST(LsysVariables, localValuesThatNobodyReadsAreAWarning) {
    testing::LsysModel model("modules A\nvariable count = 0\naxiom A\nA : * { cuont = count + 1 } -> A");
    EXPECT_THAT(model.errors(), HasSubstr("nothing reads the local value 'cuont'"));
    EXPECT_THAT(model.errors(), HasSubstr("did you mean 'count'?"));
}

TEST(LsysVariables, stagesSeeTheWordAfterEachStep) {
    for (const char* const block : {"{}", "{ n = n + 1 }"}) {
        testing::LsysModel model(
            fmt::format("modules A B\nvariable n = 0\naxiom A(0)\nA(x) : * {} -> A(x+1)B", block));
        std::vector<std::uint32_t> steps;
        const auto word = model.derive_by(4, [&](std::uint32_t step, ModuleString& now) {
            steps.push_back(step);
            ModuleTable& table = model.rewriter().modules();
            const double parameter = table.parameters(now[0])[0] * 10;
            now[0] = table.intern(table.symbol(now[0]), std::span(&parameter, 1));
            return true;
        });
        EXPECT_THAT(steps, ::testing::ElementsAre(0, 1, 2, 3, 4));
        ASSERT_TRUE(word) << model.errors();
        EXPECT_EQ(model.text(*word), "A(11110)BBBB");
    }
}

TEST(LsysVariables, aStageEndsADerivation) {
    for (const char* const block : {"{}", "{ n = n + 1 }"}) {
        testing::LsysModel model(
            fmt::format("modules A B\nvariable n = 0\naxiom A(0)\nA(x) : * {} -> A(x+1)B", block));
        EXPECT_FALSE(model.derive_by(4, [](std::uint32_t step, ModuleString&) { return step < 2; }));
    }
}

} // namespace
} // namespace graftal
