#include "compiler/lsys/derive/folded_word.h"

#include <map>
#include <string>

#include <gtest/gtest.h>

#include "tests/unit/lsys/words.h"

namespace graftal {
namespace {

/// Derives and folds a word.
struct Folded {
    Folded(const std::string& statements, unsigned steps, std::uint64_t seed = 0)
        : model(statements), word(model.derive(steps, seed).value()),
          folded(model.rewriter().grammar(), model.rewriter().modules(), word) {}

    /// The modules of the pieces, brackets left out.
    ModuleString unfolded() {
        ModuleString out;
        unfold(folded.trunk(), out);
        return out;
    }
    ModuleString without_brackets() {
        ModuleString out;
        for (const ModuleId module : word)
            if (model.symbol(module) != "[" && model.symbol(module) != "]") out.push_back(module);
        return out;
    }

    void unfold(std::span<const ModuleId> string, ModuleString& out) {
        for (const ModuleId module : string) {
            if (!FoldedWord::is_piece(module)) {
                out.push_back(module);
                continue;
            }
            if (const auto [at, added] = sizes.emplace(module, folded.piece(module).size()); added)
                kept += at->second;
            branches += FoldedWord::is_branch(module);
            unfold(folded.piece(module), out);
        }
    }

    testing::LsysModel model;
    ModuleString word;
    FoldedWord folded;
    std::map<ModuleId, std::size_t> sizes;
    std::size_t kept = 0; ///< modules of all pieces, each once
    std::size_t branches = 0;
};

TEST(FoldedWord, unfoldsToTheWord) {
    for (const char* statements : {
             "axiom F--F--F\nF -> F+F--F+F",
             "axiom X\nX -> F-[[X]+X]+F[+FX]-X\nF -> FF",
             "axiom F\nF -> F[+F]F[-F]F : 0.33\nF -> F[+F]F : 0.33\nF -> F[-F]F : 0.34",
             "modules A\naxiom A(1)\nA(x) -> A(2*x)F(x)A(2*x+1)",
             "modules A\naxiom A\nA -> [&FL!A]/[&FL!A]FF\nL -> ['''^^{-f+f[+f]f-|-f+f+f}]",
         }) {
        Folded model(statements, 7, 1);
        EXPECT_EQ(model.unfolded(), model.without_brackets()) << statements;
        EXPECT_LE(model.folded.trunk().size(), 256u) << statements;
    }
}

TEST(FoldedWord, keepsWhatIsEqualOnce) {
    Folded koch("axiom F--F--F\nF -> F+F--F+F", 9);
    ASSERT_EQ(koch.unfolded().size(), 1835008u);
    EXPECT_LT(koch.kept, 4000u);
    Folded plant("axiom X\nX -> F-[[X]+X]+F[+FX]-X\nF -> FF", 9);
    ASSERT_EQ(plant.unfolded().size() + 2 * plant.branches, plant.word.size());
    EXPECT_LT(plant.kept, 4000u);
    Folded equal("axiom F\nF -> FF", 20);
    ASSERT_EQ(equal.unfolded().size(), 1u << 20);
    EXPECT_LT(equal.kept + equal.folded.trunk().size(), 500u);
}

TEST(FoldedWord, doesNotCutPolygons) {
    Folded polygons("axiom FFFF\nF -> F{f+f+f}F", 8);
    polygons.unfolded();
    for (const auto& [number, size] : polygons.sizes) {
        int open = 0;
        for (const ModuleId module : polygons.folded.piece(number))
            if (!FoldedWord::is_piece(module))
                open += (polygons.model.symbol(module) == "{") - (polygons.model.symbol(module) == "}");
        EXPECT_EQ(open, 0);
    }
    Folded one("axiom {F}\nF -> FF", 10);
    EXPECT_EQ(one.unfolded(), one.without_brackets());
    Folded crossing("axiom [{.]FFF[.}]\nF -> FF", 9);
    EXPECT_EQ(crossing.folded.trunk().size(), crossing.word.size());
}

} // namespace
} // namespace graftal
