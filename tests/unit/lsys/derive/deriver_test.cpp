#include "compiler/lsys/derive/deriver.h"

#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/lsys/words.h"

namespace graftal {
namespace {

using testing::derived;
using ::testing::HasSubstr;
using testing::LsysModel;

TEST(LsysDeriver, stepsRewriteAllModulesAtOnce) {
    EXPECT_EQ(derived("modules A B\naxiom AB\nA -> B\nB -> A", 1), "BA");
    EXPECT_EQ(derived("modules A B\naxiom AB\nA -> B\nB -> A", 2), "AB");
    EXPECT_EQ(derived("modules A B\naxiom A+B\nA -> *", 1), "+B");
    EXPECT_EQ(derived("modules A B\naxiom A\nA -> *", 5), "");
    EXPECT_EQ(derived("modules A\naxiom A(1)A\nA(n) -> A(n+1)", 3), "A(4)A");
    EXPECT_EQ(derived("modules A\naxiom A(3)\nA(n) : n > 0 -> A(n-1)F(n)", 10'000), "A(0)F(1)F(2)F(3)");
}

TEST(LsysDeriver, firstRuleThatFitsIsApplied) {
    const std::string rules = "modules A B C D\nA(n) : n > 5 -> B\nA(n) : n > 2 -> C\nA(n) -> D\n";
    EXPECT_EQ(derived(rules + "axiom A(6)A(3)A(1)", 1), "BCD");
}

TEST(LsysDeriver, longSuccessors) {
    for (const std::size_t length : {7, 8, 9, 16, 17, 255, 256, 257, 5000}) {
        std::string successor;
        for (std::size_t i = 0; i < length; ++i)
            successor += "FG+-fgL"[i % 7];
        EXPECT_EQ(derived("modules A L\naxiom ALA\nA -> " + successor, 1), successor + "L" + successor)
            << length;
    }
}

/// Pearson's statistic of how often words have each of some symbols.
double chi_squared(const std::map<std::string, double>& seen,
                   const std::map<std::string, double>& probabilities) {
    double count = 0;
    for (const auto& [symbol, n] : seen)
        count += n;
    double sum = 0;
    for (const auto& [symbol, probability] : probabilities) {
        const double wanted = count * probability;
        const double found = seen.contains(symbol) ? seen.at(symbol) : 0;
        sum += (found - wanted) * (found - wanted) / wanted;
    }
    return sum;
}

std::map<std::string, double> frequencies(const LsysModel& model, const ModuleString& word,
                                          std::size_t group) {
    std::map<std::string, double> seen;
    for (std::size_t i = 0; i + group <= word.size(); i += group) {
        std::string symbols;
        for (std::size_t k = 0; k < group; ++k)
            symbols += model.symbol(word[i + k]);
        seen[symbols] += 1;
    }
    return seen;
}

const std::map<std::string, double> chances = {{"A", 0.2}, {"B", 0.3}, {"C", 0.5}};
const std::string growing = "modules A B C D E S\naxiom S(16)D\nS(n) : n > 0 -> S(n-1)S(n-1)\nS(n) -> E\n";

TEST(LsysDeriver, chanceFollowsTheProbabilities) {
    const std::vector<std::pair<std::string, unsigned>> systems = {
        {"E -> A : 0.2\nE -> B : 0.3\nE -> C : 0.5", 18},
        // By contexts, near and far, and among those without.
        {"E > E -> A : 0.2\nE > D -> A : 0.2\nE -> B : 0.3\nE -> C : 0.5", 18},
        {"E > E E -> A : 0.2\nE > E D -> A : 0.2\nE > D -> A : 0.2\nE -> B : 0.3\nE -> C : 0.5", 18},
        {"decompose {\nE -> A : 0.2\nE -> B : 0.3\nE -> C : 0.5\n}", 17},
    };
    std::map<std::string, double> pairs;
    for (const auto& [first, p] : chances)
        for (const auto& [second, q] : chances)
            pairs[first + second] = p * q;
    for (const auto& [rules, steps] : systems)
        for (const std::uint64_t seed : {0, 1, 2}) {
            LsysModel model(growing + rules);
            ModuleString word = model.derive(steps, seed).value();
            word.pop_back(); // D
            ASSERT_EQ(word.size(), 65536u);
            EXPECT_LT(chi_squared(frequencies(model, word, 1), chances), 13.8) << rules; // 2 degrees, 0.1 %
            EXPECT_LT(chi_squared(frequencies(model, word, 2), pairs), 26.1) << rules;   // 8 degrees, 0.1 %
        }
}

TEST(LsysDeriver, chanceIsTheSeedsAlone) {
    const std::string text = "axiom F\nF -> F[+F]F[-F]F : 0.33\nF -> F[+F]F : 0.33\nF -> F[-F]F : 0.34";
    LsysModel model(text);
    const auto word = model.derive(5, 42);
    EXPECT_EQ(model.derive(5, 42), word);
    EXPECT_NE(model.derive(5, 43), word);
    EXPECT_NE(model.derive(5, 42 + 0x9E3779B97F4A7C15), word);
    // Stays as it is: pictures of stochastic plants depend on it.
    EXPECT_EQ(derived(text, 2, 1), "F[+F]F[-F[+F]F]F[+F]F[-F]F");
}

TEST(LsysDeriver, equalModulesOfOneStepChooseApart) {
    const std::string word = derived("modules A B S\naxiom S(6)\nS(n) : n > 0 -> S(n-1)S(n-1)\n"
                                     "S(n) : n == 0 -> A : 1/2\nS(n) : n == 0 -> B : 1/2",
                                     7);
    EXPECT_THAT(word, HasSubstr("A"));
    EXPECT_THAT(word, HasSubstr("B"));
}

TEST(LsysDeriver, rulesOfNoProbabilityAreNotChosen) {
    EXPECT_EQ(derived("modules A B C D\naxiom AAAA\nA -> B : 0\nA -> C : 1\nA -> D : 0", 1), "CCCC");
    // Once one with a probability fits, those without do not compete.
    EXPECT_EQ(derived("modules A B C\naxiom AAAA\nA -> B : 1\nA -> C", 1), "BBBB");
}

TEST(LsysDeriver, cutRemovesTheRestOfItsBranch) {
    const std::string text = "modules A B C\nA -> %\n";
    EXPECT_EQ(derived(text + "axiom B[CAB[C]B]B", 1), "B[C%]B");
    EXPECT_EQ(derived(text + "axiom B[CAB[AC]B[]C]BAB[C]", 1), "B[C%]B%");
    EXPECT_EQ(derived(text + "axiom B[[A]C][AB]C", 1), "B[[%]C][%]C");
    EXPECT_EQ(derived(text + "axiom C%B", 0), "C%");
    EXPECT_EQ(derived(text + "axiom [C%B]AB\nC -> CB", 1), "[CB%]%");
}

TEST(LsysDeriver, decomposition) {
    const std::string rules = "modules A B I\naxiom I(2)\n"
                              "decompose I(n) : n > 0 -> I(n-1)F\n"
                              "I(n) -> B I(1)\nB -> A\ndecompose A -> [F]\n";
    EXPECT_EQ(derived(rules, 0), "I(0)FF");
    EXPECT_EQ(derived(rules, 1), "BI(0)FFF");
    EXPECT_EQ(derived(rules, 2), "[F]BI(0)FFFF");
    EXPECT_EQ(derived("modules A B\naxiom AB\ndecompose { A -> BB\nB -> *\n}", 0), "");
    // By chance: what is decomposed differently stays apart.
    LsysModel model("modules A B C\naxiom AAAAAAAAAAAAAAAA\ndecompose { A -> B : 1/2\nA -> AC : 1/2\n}");
    const std::string word = model.text(model.derive(0, 3).value());
    EXPECT_THAT(word, HasSubstr("BB"));
    EXPECT_THAT(word, HasSubstr("BC"));
    EXPECT_EQ(word, model.text(model.derive(0, 3).value()));
}

TEST(LsysDeriver, endlessDecompositionsAreErrors) {
    const std::vector<std::string> endless = {
        "axiom A\ndecompose A -> A",
        "axiom A\ndecompose A -> AA",
        "axiom A\ndecompose A -> BA\ndecompose B -> *",
        "axiom A(0)\ndecompose A(n) -> A(n+1)A(n+2)",
        "axiom A(0)\ndecompose A(n) : n < 600 -> A(n+1)A(n+1)\ndecompose A(n) -> *",
        "axiom C\nC -> A\ndecompose A -> A",
        "axiom A\ndecompose A -> A : 1/2\ndecompose A -> AA : 1/2",
        "axiom C\nC -> A\ndecompose A -> FFA : 1/2\ndecompose A -> AF : 1/2",
    };
    for (const std::string& text : endless) {
        LsysModel model("modules A B C\n" + text);
        EXPECT_FALSE(model.derive(3, 0, 1'000'000)) << text;
        EXPECT_EQ(model.diagnostics().error_count(), 1u) << text << model.errors();
        EXPECT_THAT(model.errors(), HasSubstr("the decomposition of 'A'")) << text;
        EXPECT_THAT(model.errors(), HasSubstr("hint: ")) << text;
    }
}

TEST(LsysDeriver, longWordsAreErrorsBeforeTheyTakeMemory) {
    EXPECT_EQ(derived("steps 5\naxiom F\nF -> FF", 20, 0, 1000),
              R"(m.lsys:2:1: error: the derivation has more than 1000 modules after step 10
    steps 5
    ^~~~~
    hint: use fewer steps for a shorter one
)");
    EXPECT_EQ(derived("axiom F\nF -> FF", 3, 0, 8), "FFFFFFFF");
    EXPECT_THAT(derived("axiom FFF", 0, 0, 2), HasSubstr("more than 2 modules after step 0"));
    EXPECT_THAT(derived("axiom F\nF -> FF : 1", 20, 0, 1000),
                HasSubstr("more than 1000 modules after step 10"));
    EXPECT_THAT(derived("axiom FFF\nF < F > F -> FFFF", 20, 0, 1000), HasSubstr("more than 1000 modules"));
    // 10^5 modules become 10^10.
    const std::string many(99'000, 'F');
    EXPECT_THAT(derived("axiom F\nF -> " + many, 2, 0, max_word_modules),
                HasSubstr("more than 4000000000 modules after step 2"));
}

TEST(LsysDeriver, errorsAreReportedOnce) {
    const std::vector<std::pair<std::string, std::string>> cases = {
        {"axiom A(1)A(1)A(2)\nA(x) : 1/(x-1) > 0 -> F", "division by zero"},
        {"axiom A(1)A(1)A(2)\nA(x) -> F(1/(x-1))", "division by zero"},
        {"axiom A(1)A(1)A(2)\nA(x) -> F : x - 2\nA(x) -> F : 1",
         "a probability must not be negative, but is -1"},
        {"axiom A(1)A(1)\nA(x) -> F : 0.5\nA(x) -> FF : 0.6", "sum to 1.1, not to 1"},
        {"axiom A(1)A(1)\nA(x) < A(y) -> F : 0.5\nA(x) -> FF : 1.4", "sum to 1.4, not to 1"},
        {"axiom A(1)A(1)\nA(x) < A(y) -> F : 0.5\nA(x) -> FF : 1", "sum to 1.5, not to 1"},
        {"axiom A(1)A(1)A(1)\nA(z)A(x) < A(y) : 1/(x-1) -> F", "division by zero"},
        {"axiom A(1)A(1)\nA(x) < A(y) -> F(1/(x-y))", "division by zero"},
        {"axiom A(1)\ndecompose A(x) -> F(1/(x-1))", "division by zero"},
        {"axiom F\nF -> A(1)\ndecompose A(x) -> F : x / 2", "sum to 0.5, not to 1"},
    };
    for (const auto& [text, message] : cases) {
        LsysModel model("modules A\n" + text);
        EXPECT_FALSE(model.derive(2)) << text;
        EXPECT_FALSE(model.derive(2)) << text;
        EXPECT_THAT(model.errors(), HasSubstr(message)) << text;
    }
    LsysModel model("modules A\naxiom A(1)A(1)A(2)\nA(x) -> F(1/(x-1))");
    LsysDeriver deriver(model.rewriter(), model.diagnostics(), 0, 1000);
    EXPECT_FALSE(deriver.derive(2));
    EXPECT_FALSE(deriver.derive(2));
    EXPECT_EQ(model.diagnostics().error_count(), 1u);
}

TEST(LsysDeriver, derivesAgainFromTheAxiom) {
    LsysModel model("axiom F\nF -> F+F");
    LsysDeriver deriver(model.rewriter(), model.diagnostics(), 0, 1000);
    EXPECT_EQ(model.text(deriver.derive(2).value()), "F+F+F+F");
    EXPECT_EQ(model.text(deriver.derive(1).value()), "F+F");
}

} // namespace
} // namespace graftal
