// Productions that rewrite several modules at once, among others against a deriver that walks the word as
// cpfg does.

#include <cstddef>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/lsys/words.h"

namespace graftal {
namespace {

using testing::derived;
using ::testing::HasSubstr;

TEST(LsysPredecessors, areRewrittenTogether) {
    const std::string modules = "modules A B C D\n";
    EXPECT_EQ(derived(modules + "axiom A B A B A\nA B -> C", 1), "CCA");
    EXPECT_EQ(derived(modules + "axiom A(1)B(2)C\nA(a) B(b) : a < b -> D(a+b)", 1), "D(3)C");
    EXPECT_EQ(derived(modules + "axiom A(3)B(2)C\nA(a) B(b) : a < b -> D(a+b)", 1), "A(3)B(2)C");
    EXPECT_EQ(derived(modules + "axiom A A A A A\nA A -> A", 1), "AAA");
    EXPECT_EQ(derived(modules + "axiom A A A A A\nA A -> A", 3), "A");
    EXPECT_EQ(derived(modules + "axiom A B C\nA B C -> *", 1), "");
    EXPECT_EQ(derived(modules + "axiom A B(1)\nA B -> C", 1), "AB(1)"); // another module
}

TEST(LsysPredecessors, standSideBySide) {
    EXPECT_EQ(derived("modules A B C\nignore +\naxiom A+B\nA B -> C", 1), "A+B");
    EXPECT_EQ(derived("modules A B C\naxiom A[F]B\nA B -> C", 1), "A[F]B");
}

TEST(LsysPredecessors, firstOfTheTextThatFitsWins) {
    const std::string axiom = "modules A B C D\naxiom A A B\n";
    EXPECT_EQ(derived(axiom + "A -> C\nA B -> D", 1), "CCB");
    EXPECT_EQ(derived(axiom + "A B -> D\nA -> C", 1), "CD");
    // With a context it comes first, unless the text decides.
    EXPECT_EQ(derived(axiom + "A -> C\nA < A B -> D", 1), "CD");
    EXPECT_EQ(derived("precedence contexts\n" + axiom + "A -> C\nA < A B -> D", 1), "CD");
    EXPECT_EQ(derived("precedence text\n" + axiom + "A -> C\nA < A B -> D", 1), "CCB");
}

TEST(LsysPredecessors, mayHaveBrackets) {
    const std::string modules = "modules A B C X\n";
    EXPECT_EQ(derived(modules + "axiom A[B]C\nA [ B ] C -> X", 1), "X");
    EXPECT_EQ(derived(modules + "axiom A[B]C[B]\n] -> X]", 1), "A[BX]C[BX]");
    EXPECT_EQ(derived(modules + "axiom A[B]C[B]\n[ -> [X", 2), "A[XXB]C[XXB]");
    EXPECT_EQ(derived(modules + "axiom A[B]C\nB ] C -> C ] B", 1), "A[C]B");
    EXPECT_EQ(derived(modules + "axiom A[B][C]\n] [ -> *", 1), "A[BC]");
    EXPECT_EQ(derived(modules + "axiom A[B]C\n[ B ] -> B", 1), "ABC");
}

TEST(LsysPredecessors, haveContextsAroundAllOfThem) {
    const std::string modules = "modules A B C D X\n";
    EXPECT_EQ(derived(modules + "axiom C A B D\nC C < A B -> A\nC < A B > D -> X", 1), "CXD");
    EXPECT_EQ(derived(modules + "axiom C A B D\nC < A B > C -> X", 1), "CABD");
    EXPECT_EQ(derived(modules + "axiom C[A B]D\nC < A B -> X", 1), "C[X]D");
    EXPECT_EQ(derived(modules + "axiom A[B]D\nA [ B ] > D -> X", 1), "XD");
    EXPECT_EQ(derived(modules + "axiom A[B]D\n] > D -> X]", 1), "A[BX]D");
    EXPECT_EQ(derived(modules + "axiom A(1)B(2)C(3)D(4)\nA(a) < B(b) C(c) > D(d) -> X(a,b,c,d)", 1),
              "A(1)X(1,2,3,4)D(4)");
}

TEST(LsysPredecessors, competeByChance) {
    const std::string model = "modules A B C D\naxiom A B A B A B A B\nA B -> C : 0.5\nA -> D : 0.5";
    std::size_t pairs = 0, words = 0;
    for (std::uint64_t seed = 0; seed < 500; ++seed) {
        const std::string word = derived(model, 1, seed);
        for (std::size_t i = 0; i < word.size(); ++i, ++words) {
            pairs += word[i] == 'C';
            ASSERT_TRUE(word[i] == 'C' || word.substr(i++, 2) == "DB") << word;
        }
    }
    EXPECT_EQ(words, 2000u);
    EXPECT_NEAR(static_cast<double>(pairs), 1000, 4 * 23);
}

TEST(LsysPredecessors, agesCountFromTheFirst) {
    EXPECT_EQ(derived("modules A B C\naxiom A B\nB -> B\nA B : age == 3 -> C(age)", 3), "C(3)");
}

TEST(LsysPredecessors, mistakesAreReported) {
    const std::string modules = "modules A B C\naxiom A B\n";
    EXPECT_THAT(derived(modules + "A [ B -> C", 1), HasSubstr("this successor closes 0 and opens 0"));
    EXPECT_THAT(derived(modules + "A ] -> [", 1), HasSubstr("the predecessor closes 1 and opens 0"));
    EXPECT_THAT(derived(modules + "A { -> A", 1), HasSubstr("a brace cannot be rewritten"));
    EXPECT_THAT(derived(modules + "A % -> A", 1), HasSubstr("a cut cannot be rewritten"));
    EXPECT_THAT(derived(modules + "A B -> C\ninterpret A B -> F", 1),
                HasSubstr("rewrites one module, not 2"));
    EXPECT_THAT(derived(modules + "interpret [ -> F[", 1), HasSubstr("only a derivation step"));
    EXPECT_THAT(derived(modules + "A(x) B(x) -> C", 1), HasSubstr("duplicate parameter 'x'"));
    EXPECT_THAT(derived(modules + "A---> C", 1), HasSubstr("this arrow has too many signs"));
    EXPECT_THAT(derived(modules + "precedence none\nA B -> C", 1),
                HasSubstr("expected 'text' or 'contexts'"));
}

TEST(LsysPredecessors, whatIsHardlyMeant) {
    EXPECT_THAT(derived("axiom B u d\nBud -> F", 1), HasSubstr("'Bud' is read letter by letter"));
    EXPECT_EQ(derived("modules u\naxiom B u d\nB u d -> F", 1), "F");
    testing::LsysModel never("modules A B\naxiom A\nA B -> F");
    EXPECT_THAT(never.errors(), HasSubstr("this production never applies"));
}

/// `pattern -> successor`, letters and brackets.
struct MatchedRule {
    std::string predecessor;
    std::string successor;
};

std::string plainly_derived(const std::string& word, const std::vector<MatchedRule>& rules) {
    std::string out;
    for (std::size_t at = 0; at < word.size();) {
        const MatchedRule* fits = nullptr;
        for (const MatchedRule& rule : rules)
            if (!fits && word.compare(at, rule.predecessor.size(), rule.predecessor) == 0) fits = &rule;
        out += fits ? fits->successor : word.substr(at, 1);
        at += fits ? fits->predecessor.size() : 1;
    }
    return out;
}

/// Random letters with brackets that match.
class RandomTexts {
  public:
    explicit RandomTexts(unsigned seed) : engine_(seed) {}

    std::size_t below(std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(engine_); }
    std::string text(std::size_t items, std::size_t depth) {
        std::string out;
        for (; items > 0; --items)
            out += depth > 0 && below(4) == 0 ? "[" + text(below(items + 1), depth - 1) + "]"
                                              : std::string(1, "ABC"[below(3)]);
        return out;
    }
    /// A pattern that may close and open branches, and a successor that does the same.
    MatchedRule rule() {
        MatchedRule rule;
        const bool closes = below(4) == 0, opens = below(4) == 0;
        for (std::string* side : {&rule.predecessor, &rule.successor}) {
            *side = text(below(3), 1);
            if (closes) *side += "]" + text(below(2), 1);
            if (opens) *side += "[" + text(below(2), 1);
        }
        if (rule.predecessor.empty()) rule.predecessor = "A";
        return rule;
    }

  private:
    std::mt19937 engine_;
};

std::string spaced(const std::string& text) {
    return fmt::format("{}", fmt::join(text, " "));
}

TEST(LsysPredecessors, wordsAreThoseOfAPlainDeriver) {
    std::size_t changed = 0;
    for (unsigned seed = 0; seed < 2000; ++seed) {
        RandomTexts random(seed);
        const std::string axiom = "A" + random.text(8, 2);
        std::vector<MatchedRule> rules;
        std::string statements = "modules A B C\naxiom " + spaced(axiom) + "\n";
        for (std::size_t i = 0; i < 3; ++i) {
            rules.push_back(random.rule());
            statements += fmt::format("{} -> {}\n", spaced(rules[i].predecessor),
                                      rules[i].successor.empty() ? "*" : spaced(rules[i].successor));
        }
        std::string word = axiom;
        for (unsigned step = 0; step < 3; ++step)
            word = plainly_derived(word, rules);
        changed += word != axiom;
        ASSERT_EQ(derived(statements, 3), word) << statements;
    }
    EXPECT_GT(changed, 1500u);
}

} // namespace
} // namespace graftal
