// Contexts in bracketed words, among others against a matcher that walks the word as the book tells it.

#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/lsys/words.h"

namespace graftal {
namespace {

using testing::derived;

/// A rule whose pattern letters may stand in brackets; `predecessor` and words of one-letter symbols.
struct PlainRule {
    std::string left;
    char predecessor;
    std::string right;
};

/// ABOP, section 1.8, word by word and with backtracking.
class PlainMatcher {
  public:
    PlainMatcher(std::string_view word, std::string_view ignored) : word_(word), ignored_(ignored) {}

    /// The positions of the context's letters, or nothing.
    std::optional<std::vector<std::size_t>> match(const PlainRule& rule, std::size_t position) const {
        if (word_[position] != rule.predecessor) return std::nullopt;
        std::vector<std::size_t> bound(rule.left.size());
        std::size_t at = position;
        for (std::size_t i = rule.left.size(); i-- > 0;) {
            const auto before = parent(at);
            if (!before || word_[*before] != rule.left[i]) return std::nullopt;
            bound[i] = at = *before;
        }
        const auto right = match_right(position + 1, rule.right);
        if (!right) return std::nullopt;
        bound.insert(bound.end(), right->begin(), right->end());
        return bound;
    }

  private:
    bool is_ignored(std::size_t at) const { return ignored_.find(word_[at]) != std::string_view::npos; }

    std::optional<std::size_t> parent(std::size_t at) const {
        int closed = 0;
        while (at-- > 0) {
            if (word_[at] == ']')
                ++closed;
            else if (word_[at] == '[')
                closed -= closed > 0 ? 1 : 0;
            else if (closed == 0 && !is_ignored(at))
                return at;
        }
        return std::nullopt;
    }

    static std::size_t closing(std::string_view text, std::size_t open) {
        for (int depth = 0;; ++open) {
            depth += text[open] == '[' ? 1 : text[open] == ']' ? -1 : 0;
            if (depth == 0) return open;
        }
    }

    std::optional<std::vector<std::size_t>> match_right(std::size_t at, std::string_view pattern) const {
        if (pattern.empty()) return std::vector<std::size_t>();
        for (; at < word_.size() && word_[at] != ']'; ++at) {
            if (word_[at] == '[') {
                const std::size_t close = closing(word_, at);
                if (pattern[0] == '[')
                    if (auto matched = match_branch(at, close, pattern)) return matched;
                at = close;
            } else if (!is_ignored(at)) {
                if (pattern[0] != word_[at]) return std::nullopt;
                return joined({at}, match_right(at + 1, pattern.substr(1)));
            }
        }
        return std::nullopt;
    }

    std::optional<std::vector<std::size_t>> match_branch(std::size_t open, std::size_t close,
                                                         std::string_view pattern) const {
        const std::size_t end = closing(pattern, 0);
        const auto inside = match_right(open + 1, pattern.substr(1, end - 1));
        if (!inside) return std::nullopt;
        return joined(*inside, match_right(close + 1, pattern.substr(end + 1)));
    }

    static std::optional<std::vector<std::size_t>>
    joined(std::vector<std::size_t> first, const std::optional<std::vector<std::size_t>>& rest) {
        if (!rest) return std::nullopt;
        first.insert(first.end(), rest->begin(), rest->end());
        return first;
    }

    std::string_view word_;
    std::string_view ignored_;
};

class RandomWords {
  public:
    explicit RandomWords(unsigned seed) : engine_(seed) {}

    std::size_t below(std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(engine_); }
    char letter(std::string_view letters) { return letters[below(letters.size())]; }
    std::string word(std::string_view letters, std::size_t items, std::size_t depth) {
        std::string out;
        for (; items > 0; --items)
            out += depth > 0 && below(4) == 0 ? "[" + word(letters, below(items + 1), depth - 1) + "]"
                                              : std::string(1, letter(letters));
        return out;
    }

  private:
    std::mt19937 engine_;
};

/// With the position of each letter as its parameter.
std::string numbered(std::string_view word) {
    std::string out;
    for (std::size_t i = 0; i < word.size(); ++i)
        out += word[i] == '[' || word[i] == ']' ? std::string(1, word[i]) : fmt::format("{}({})", word[i], i);
    return out;
}

/// Pattern letters with names for their parameters; the names are added to `names`.
std::string named(std::string_view pattern, std::vector<std::string>& names) {
    std::string out;
    for (const char letter : pattern) {
        out += letter;
        if (letter == '[' || letter == ']') continue;
        names.push_back(fmt::format("x{}", names.size()));
        out += "(" + names.back() + ")";
    }
    return out;
}

std::string listed(const std::vector<std::string>& names) {
    return fmt::format("({})", fmt::join(names, ","));
}

/// In a step, X stands for what matched: the predecessor's position, then those of the contexts.
std::string expected(const std::string& word, const PlainRule& rule, std::string_view ignored) {
    const PlainMatcher matcher(word, ignored);
    std::string out;
    for (std::size_t i = 0; i < word.size(); ++i) {
        std::vector<std::string> values = {std::to_string(i)};
        const auto bound = matcher.match(rule, i);
        if (bound)
            for (const std::size_t position : *bound)
                values.push_back(std::to_string(position));
        out += bound ? "X" + listed(values)
                     : numbered(word.substr(0, i + 1)).substr(numbered(word.substr(0, i)).size());
    }
    return out;
}

TEST(LsysContext, randomRulesOnRandomWordsAsAPlainMatcherSays) {
    RandomWords random(7);
    int matched = 0;
    for (int i = 0; i < 3000; ++i) {
        const std::string word = random.word("AABBC+", 12, 3) + "A";
        const PlainRule rule = {random.word("AB", random.below(3), 0), random.letter("AAABC+"),
                                random.word("ABC", random.below(4), 2)};
        std::vector<std::string> names;
        const std::string predecessor = named(std::string(1, rule.predecessor), names);
        const std::string left = named(rule.left, names);
        const std::string right = named(rule.right, names);
        const std::string text = fmt::format("modules A B C X\nignore +\naxiom {}\n{}{}{} -> X{}",
                                             numbered(word), left.empty() ? "" : left + " < ", predecessor,
                                             right.empty() ? "" : " > " + right, listed(names));
        const std::string after = derived(text, 1);
        ASSERT_EQ(after, expected(word, rule, "+")) << text;
        matched += after.find('X') != std::string::npos;
    }
    EXPECT_GT(matched, 500);
}

TEST(LsysContext, figure129) {
    // The S has the left context BC and the right context G[H]M, although branches stand between.
    const std::string text = "modules A B C D E S G H I J K L M N O X\n"
                             "axiom ABC[DE][SG[HI[JK]L]MNO]\n";
    EXPECT_EQ(derived(text + "B C < S > G[H]M -> X", 1), "ABC[DE][XG[HI[JK]L]MNO]");
    EXPECT_EQ(derived(text + "C < D -> X", 1), "ABC[XE][SG[HI[JK]L]MNO]");
    EXPECT_EQ(derived(text + "B C < S > G[H]N -> X", 1), "ABC[DE][SG[HI[JK]L]MNO]");
    EXPECT_EQ(derived(text + "B C < S > GM -> X", 1), "ABC[DE][XG[HI[JK]L]MNO]");
    EXPECT_EQ(derived(text + "B C < S > G[I]M -> X", 1), "ABC[DE][SG[HI[JK]L]MNO]");
    EXPECT_EQ(derived(text + "C > S -> X", 1), "ABC[DE][SG[HI[JK]L]MNO]");
    EXPECT_EQ(derived(text + "C > [S] -> X", 1), "ABX[DE][SG[HI[JK]L]MNO]");
    EXPECT_EQ(derived(text + "C > [S][D] -> X", 1), "ABC[DE][SG[HI[JK]L]MNO]");
}

TEST(LsysContext, signalsOfAbopFigure130) {
    const std::string axiom = "modules a b\nignore + -\naxiom ";
    // Acropetal: from the root to all tips.
    const std::string up = axiom + "b[+a]a[-a]a[+a]a\nb < a -> b";
    EXPECT_EQ(derived(up, 0), "b[+a]a[-a]a[+a]a");
    EXPECT_EQ(derived(up, 1), "b[+b]b[-a]a[+a]a");
    EXPECT_EQ(derived(up, 2), "b[+b]b[-b]b[+a]a");
    EXPECT_EQ(derived(up, 3), "b[+b]b[-b]b[+b]b");
    // Basipetal: from a tip to the root, along the axis.
    const std::string down = axiom + "a[+a]a[-a]a[+a]b\na > b -> b";
    EXPECT_EQ(derived(down, 1), "a[+a]a[-a]b[+a]b");
    EXPECT_EQ(derived(down, 2), "a[+a]b[-a]b[+a]b");
    EXPECT_EQ(derived(down, 3), "b[+a]b[-a]b[+a]b");
    EXPECT_EQ(derived(axiom + "a[+b]a\na > [b] -> b", 1), "b[+b]a");
}

TEST(LsysContext, signalInAStringOfAbopSection18) {
    const std::string text = "modules a b\naxiom baaaaaaaa\nb < a -> b\nb -> a";
    EXPECT_EQ(derived(text, 1), "abaaaaaaa");
    EXPECT_EQ(derived(text, 2), "aabaaaaaa");
    EXPECT_EQ(derived(text, 3), "aaabaaaaa");
}

TEST(LsysContext, contextsTakePrecedence) {
    EXPECT_EQ(derived("modules A B X Y\naxiom AAB\nA -> X\nA > B -> Y", 1), "XYB");
    EXPECT_EQ(derived("modules A B X Y\naxiom AB\nA > B -> X\nA > B -> Y", 1), "XB");
}

TEST(LsysContext, considerLooksPastAllElseButBrackets) {
    EXPECT_EQ(derived("modules A B C X\nconsider A B\naxiom AC[C+B]CCB\nA > [B]B -> X", 1), "XC[C+B]CCB");
    EXPECT_EQ(derived("modules A B C X\nconsider A B\naxiom AC[C+B]CC[B]\nA > [B]B -> X", 1), "AC[C+B]CC[B]");
}

TEST(LsysContext, parametersOfContexts) {
    const std::string rule = "modules A B C D\nA(x) < B(y) > C(z) : x+y+z > 10 -> D(x)B((x+y)/2)C(z)\n";
    EXPECT_EQ(derived(rule + "axiom A(4)B(5)C(6)", 1), "A(4)D(4)B(4.5)C(6)C(6)");
    EXPECT_EQ(derived(rule + "axiom A(4)B(5)C(1)", 1), "A(4)B(5)C(1)");
    EXPECT_EQ(derived(rule + "axiom A(4)B(5)C(6,1)", 1), "A(4)B(5)C(6,1)");
    EXPECT_EQ(derived(rule + "axiom A(1)B(5)C(6)A(4)B(5)C(6)A(0)B(0)C(0)", 1),
              "A(1)D(1)B(3)C(6)C(6)A(4)D(4)B(4.5)C(6)C(6)A(0)B(0)C(0)");
    EXPECT_EQ(derived("modules A B C\naxiom A(1)A(2)B(3)[C(4)]A(5)\n"
                      "A(a)A(b) < B(x) > [C(c)]A(d) -> C(1000*a+100*b+10*c+d)",
                      1),
              "A(1)A(2)C(1245)[C(4)]A(5)");
}

/// The five bushes of ABOP, figure 1.31, as what `left < F > right` becomes for 000, 001, ... 111.
const std::vector<std::vector<std::string>> bushes = {
    {"0", "1[+F1F1]", "1", "1", "0", "1F1", "0", "0"}, {"1", "1[-F1F1]", "1", "1", "0", "1F1", "1", "0"},
    {"0", "1", "0", "1[+F1F1]", "0", "1F1", "0", "0"}, {"1", "0", "0", "1F1", "1", "1[+F1F1]", "1", "0"},
    {"0", "1[-F1F1]", "1", "1", "0", "1F1", "1", "0"},
};

std::string bush_text(const std::vector<std::string>& successors) {
    std::string text = "ignore + - F\naxiom F1F1F1\n+ -> -\n- -> +";
    for (unsigned i = 0; i < 8; ++i)
        text += fmt::format("\n{} < {} > {} -> {}", i >> 2, i >> 1 & 1, i & 1, successors[i]);
    return text;
}

/// The word after a step, by the plain matcher.
std::string plain_step(const std::string& word, const std::vector<std::string>& successors) {
    const PlainMatcher matcher(word, "+-F");
    std::string out;
    for (std::size_t at = 0; at < word.size(); ++at) {
        std::string becomes(1, word[at] == '+' ? '-' : word[at] == '-' ? '+' : word[at]);
        for (unsigned i = 0; i < 8; ++i)
            if (matcher.match({std::string(1, '0' + static_cast<char>(i >> 2)),
                               static_cast<char>('0' + static_cast<char>(i >> 1 & 1)),
                               std::string(1, '0' + static_cast<char>(i & 1))},
                              at))
                becomes = successors[i];
        out += becomes;
    }
    return out;
}

TEST(LsysContext, bushesOfAbopFigure131) {
    for (const std::vector<std::string>& successors : bushes) {
        std::string word = "F1F1F1";
        for (unsigned step = 1; step <= 22; ++step)
            word = plain_step(word, successors);
        EXPECT_EQ(derived(bush_text(successors), 22), word);
        EXPECT_GT(word.size(), 100u);
    }
}

/// Each of these words has lookups whose lengths sum to the square of the word's.
TEST(LsysContext, hostileWordsTakeLinearTime) {
    // Ignored modules that look past each other and past all branches.
    testing::LsysModel branches("modules A B C P X\nignore P\naxiom AP\nP -> P[C]P\nP > [B] -> X\n"
                                "P > [[X]] -> X\nA < P > [CC]B -> X");
    EXPECT_GT(branches.derive(17).value().size(), 500'000u);
    // A long run of ignored modules.
    testing::LsysModel run("modules A B P X\nignore P\naxiom APPB\nP -> PP\nB < P > A -> X\nA < B -> AB");
    EXPECT_GT(run.derive(18).value().size(), 200'000u);
    // Deep brackets.
    const std::string deep = std::string(200, '[') + "D" + std::string(200, ']');
    testing::LsysModel nested("modules A B D X\naxiom AD\nA < D > [B] -> X\nA < D -> " + deep +
                              "\nB < D -> X\n"
                              "A > [[[[D]]]]B -> X");
    EXPECT_GT(nested.derive(100).value().size(), 40'000u);
}

} // namespace
} // namespace graftal
