// Words as text: published ones, and words that read back as axioms.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include "compiler/languages/lower.h"

namespace graftal {
namespace {

struct Word {
    std::string text, messages;
};

Word word_of(const std::string& model, std::optional<unsigned> steps = {}) {
    LowerOptions options;
    options.in_place = LowerOptions::InPlace::word;
    options.steps = steps;
    SourceMap sources;
    Diagnostics diagnostics;
    const LoweredText lowered = lower_text("m.lsys", model, options, sources, diagnostics);
    EXPECT_FALSE(lowered.graph);
    return {lowered.notes.word.value_or(""), diagnostics.render(sources)};
}

TEST(LsysWord, IsThatOfTheBook) {
    // ABOP, section 1.2: the filament Anabaena catenula.
    const std::string anabaena = "lsys a {\n  modules ar al br bl\n  axiom ar\n  steps 4\n  ar -> al br\n"
                                 "  al -> bl ar\n  br -> ar\n  bl -> al\n}\n";
    EXPECT_EQ(word_of(anabaena, 0).text, "ar ");
    EXPECT_EQ(word_of(anabaena, 2).text, "bl ar ar ");
    EXPECT_EQ(word_of(anabaena).text, "bl ar bl ar ar bl ar ar ");
    // Fig. 1.24a, and section 1.10 with parameters.
    const std::string weed = "lsys a {\n  axiom F\n  steps 1\n  F -> F[+F]F[-F]F\n}\n";
    EXPECT_EQ(word_of(weed).text, "F[+F]F[-F]F");
    const std::string halves =
        "lsys a {\n  axiom A(1)\n  steps 2\n  A(s) -> F(s)[+(90)A(s/2)]-(30)F(0.1)\n}\n";
    EXPECT_EQ(word_of(halves).text, "F(1)[+(90)F(0.5)[+(90)A(0.25)]-(30)F(0.1)]-(30)F(0.1)");
}

TEST(LsysWord, ReadsBackAsAnAxiom) {
    const std::string rules = "  A(l,w) : l > 0.2 -> !(w)F(l)[&(40)B(l*0.6,w*0.7)]/(137.5)A(l*0.9,w*0.7)\n"
                              "  B(l,w) -> !(w)F(l)[-(45)C(l*0.6,w*0.7)]C(l*0.9,w*0.7)\n"
                              "  C(l,w) -> !(w)F(l)[+(45)B(l*0.6,w*0.7)]B(l*0.9,w*0.7)\n";
    const std::string grown = "lsys a {\n  steps 6\n  axiom A(1,0.1)\n" + rules + "}\n";
    const Word word = word_of(grown);
    ASSERT_EQ(word.messages, "");
    const std::string copy = "lsys a {\n  steps 0\n  axiom " + word.text + "\n" + rules + "}\n";
    const auto drawn = [](const std::string& model) {
        SourceMap sources;
        Diagnostics diagnostics;
        const LoweredText lowered = lower_text("m.lsys", model, {}, sources, diagnostics);
        EXPECT_TRUE(lowered.notes.derivation) << diagnostics.render(sources);
        if (!lowered.notes.derivation) return std::string();
        return lowered.notes.derivation->modules + " " + lowered.notes.derivation->segments;
    };
    EXPECT_EQ(drawn(grown), drawn(copy));
    EXPECT_EQ(word_of(copy).text, word.text);
}

TEST(LsysWord, SaysWhereThereIsNone) {
    const std::string limit = "lsys a {\n  axiom A\n  steps infinite\n  A -> F(1)[+(30)A]\n}\n";
    EXPECT_NE(word_of(limit).messages.find("draws a limit, which has no word"), std::string::npos);
    EXPECT_EQ(word_of(limit, 1).text, "F(1)[+(30)A]");
    const std::string doubling = "lsys a {\n  axiom A\n  steps 60\n  A -> AA\n}\n";
    EXPECT_NE(word_of(doubling).messages.find("more than 5000000 modules"), std::string::npos);
}

// A random model is drawn of parts that are composed once; its word is that of the drawing.
TEST(LsysWord, OfChanceIsThatWhichIsDrawn) {
    const std::string random =
        "  A(n) : n > 0 -> F(n)[+(40)A(n*0.7)]A(n*0.9) : 0.5\n  A(n) -> F(n)A(n*0.8) : 0.3\n"
        "  A(n) -> F(n)[-(30)%F]F(0.1) : 0.2\n";
    for (std::uint64_t seed = 1; seed <= 8; ++seed)
        for (const bool exact : {false, true}) {
            LowerOptions options;
            options.seed = seed;
            options.exact = exact;
            SourceMap sources;
            Diagnostics diagnostics;
            const auto drawn = [&](const std::string& text) {
                const LoweredText lowered = lower_text("m.lsys", text, options, sources, diagnostics);
                EXPECT_TRUE(lowered.notes.derivation) << diagnostics.render(sources);
                return lowered.notes.derivation ? lowered.notes.derivation->segments : "";
            };
            const std::string model = "lsys a {\n  width 0.1\n  steps 6\n  axiom A(1)\n" + random + "}\n";
            const std::string segments = drawn(model);
            options.in_place = LowerOptions::InPlace::word;
            const std::string word =
                lower_text("m.lsys", model, options, sources, diagnostics).notes.word.value_or("");
            options.in_place = LowerOptions::InPlace::nothing;
            EXPECT_EQ(std::to_string(std::ranges::count(word, 'F')), segments) << word;
            EXPECT_EQ(drawn("lsys a {\n  width 0.1\n  steps 0\n  axiom " + word + "\n" + random + "}\n"),
                      segments);
        }
}

// Probabilities below 1 leave a rest, in which the module stays as it is, parameters and all.
TEST(LsysWord, KeepsModulesByTheRestOfProbabilities) {
    constexpr int count = 4000, steps = 2;
    std::string axiom;
    for (int i = 0; i < count; ++i)
        axiom += "A(" + std::to_string(i) + ",3)"; // equal ones would share the choices of a pool
    for (const bool exact : {false, true}) {
        LowerOptions options;
        options.in_place = LowerOptions::InPlace::word;
        options.exact = exact;
        SourceMap sources;
        Diagnostics diagnostics;
        const std::string model = "lsys a {\n  width 1\n  steps " + std::to_string(steps) + "\n  axiom " +
                                  axiom + "\n  A(x,y) -> F(x) : 0.2\n  A(x,y) -> G(y) : 0.1\n}\n";
        const std::string word =
            lower_text("m.lsys", model, options, sources, diagnostics).notes.word.value_or("");
        const auto times = [&](const std::string& part) {
            int found = 0;
            for (std::size_t at = word.find(part); at != std::string::npos; at = word.find(part, at + 1))
                ++found;
            return found;
        };
        const int stayed = times(",3)"), replaced = times("F("), other = times("G(3)");
        EXPECT_EQ(stayed + replaced + other, count);
        const double stay = std::pow(0.7, steps);
        const double four_deviations = 4 * std::sqrt(count * stay * (1 - stay));
        EXPECT_NEAR(stayed, count * stay, four_deviations) << exact;
        EXPECT_NEAR(replaced, 2 * other, 3 * four_deviations) << exact;
        EXPECT_NE(diagnostics.render(sources).find("the module stays as it is"), std::string::npos);
        EXPECT_FALSE(diagnostics.has_errors());
    }
}

TEST(LsysWord, LettersDoNotReadAsADeclaredName) {
    const Word word = word_of("lsys a {\n  modules AB ABC\n  steps 0\n  axiom A B AB A A B C [A]B F\n}\n");
    EXPECT_EQ(word.text, "A B AB AA BC[A]BF");
    EXPECT_EQ(word_of("lsys a {\n  modules AB ABC\n  steps 0\n  axiom " + word.text + "\n}\n").text,
              word.text);
}

TEST(LsysWord, TablesServeInEveryStatement) {
    EXPECT_EQ(
        word_of("lsys a {\n  table t = 0, 1, 4\n  seed t(1)\n  steps t(0.5)\n  tropism t(0.5), 0, 0, t(0)\n"
                "  variable x = t(1)\n  array b[t(0.5)] = t(0.75)\n  axiom A(0)\n"
                "  A(n) -> F(x)F(b[0])\n}\n")
            .text,
        "F(4)F(2.5)");
}

TEST(LsysWord, OneThatIsTooLongSaysAfterWhichStep) {
    LowerOptions options;
    options.in_place = LowerOptions::InPlace::word;
    options.max_modules = 100;
    SourceMap sources;
    Diagnostics diagnostics;
    lower_text("m.lsys", "lsys a {\n  axiom A\n  steps 9\n  A -> AA : 0.5\n  A -> AAA : 0.5\n}\n", options,
               sources, diagnostics);
    EXPECT_NE(diagnostics.render(sources).find("more than 100 modules after step 9"), std::string::npos)
        << diagnostics.render(sources);
}

} // namespace
} // namespace graftal
