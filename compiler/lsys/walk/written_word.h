#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "compiler/lsys/compile/grammar.h"
#include "compiler/lsys/derive/rewriter.h"
#include "compiler/lsys/turtle/witness.h"
#include "compiler/support/diagnostics.h"

namespace graftal {

/// A word as an axiom would have it: `F(1)[+(25)A(0.5)]`, numbers as the shortest decimals that read back to
/// them, and blanks about names of several letters. It is the word before interpretation.
class WrittenWord : public WordWitness {
  public:
    /// Both must outlive this. More modules are an error.
    WrittenWord(const LsysGrammar& grammar, std::uint64_t most_modules, Diagnostics& diagnostics)
        : grammar_(grammar), most_modules_(most_modules), diagnostics_(diagnostics) {}

    std::string take() && { return std::move(text_); }

    void add(SymbolId symbol, std::span<const double> parameters);
    bool begins(const Module& module, const Turtle& turtle) override;
    void closes_branch() override { text_ += ']'; }

  private:
    const LsysGrammar& grammar_;
    std::uint64_t most_modules_;
    Diagnostics& diagnostics_;
    std::uint64_t count_ = 0;
    std::string text_;
};

/// The word of a grammar after these steps, derived module by module; nothing after an error. O(modules of
/// all words).
std::optional<std::string> derived_word(LsysRewriter& rewriter, unsigned steps, std::uint64_t seed,
                                        std::uint64_t max_modules, Diagnostics& diagnostics);

} // namespace graftal
