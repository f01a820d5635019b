#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "compiler/lsys/derive/rewriter.h"
#include "compiler/support/counter_random.h"
#include "compiler/support/diagnostics.h"

namespace graftal {

/// A module that decomposes, one that this gives, and so on, may not be more than this many.
inline constexpr std::uint32_t max_decomposition_depth = 1000;

/// Reports what is wrong with the decomposition that begins with a production: it "does not end" or "is too
/// long"; false.
bool refuse_decomposition(const LsysGrammar& grammar, const LsysRule& rule, std::string_view what,
                          std::uint64_t max_modules, Diagnostics& diagnostics);

/// Applies the `decompose` productions until nothing is left to decompose (Karwowski and Prusinkiewicz 2003,
/// "Design and implementation of the L+C modeling language").
class LsysDecomposer {
  public:
    /// Both must outlive this. `max_modules` limits what run() gives, and how often it applies a production.
    LsysDecomposer(LsysRewriter& rewriter, Diagnostics& diagnostics, std::uint64_t max_modules);

    bool has_rules() const { return has_rules_; }
    /// Whether equal modules may decompose in different ways, by chance or at different times.
    bool varies() const { return varies_; }
    /// From now on, what the productions read: the step that was carried out last; 0 for the axiom.
    void set_step(std::uint32_t step) { step_ = step; }

    /// Appends what `word` decomposes into to `out`. What the module at a position becomes depends on that
    /// module and random.sequence(position) alone. False after an error.
    bool run(std::span<const ModuleId> word, const CounterRandom& random, ModuleString& out);

  private:
    struct Pending {
        ModuleId module;
        std::uint32_t depth;
    };

    bool run(ModuleId module, const CounterRandom& random, ModuleString& out);
    Moment moment(ModuleId module) const;
    bool refuse(ModuleId module, std::string_view what);

    LsysRewriter& rewriter_;
    Diagnostics& diagnostics_;
    std::uint64_t max_modules_;
    std::uint64_t applied_ = 0;
    bool has_rules_ = false;
    bool varies_ = false;
    std::uint32_t step_ = 0;
    std::vector<Pending> pending_; ///< the next one last
};

} // namespace graftal
