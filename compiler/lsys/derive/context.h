#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "compiler/lsys/compile/grammar.h"
#include "compiler/lsys/compile/module_table.h"
#include "compiler/support/id_table.h"

// Contexts of modules in bracketed strings (Prusinkiewicz and Lindenmayer, The Algorithmic Beauty of Plants,
// section 1.8): a module's left context lies on the path to the root, its right context on the axis away from
// it and in the branches there.

namespace graftal {

/// Where each module of a word has its neighbours. Made for a whole word at once, so that no run of ignored
/// modules or of branches is passed twice.
class ContextLinks {
  public:
    static constexpr std::uint32_t none = UINT32_MAX;

    explicit ContextLinks(const LsysGrammar& grammar);

    /// Requires balanced brackets and less than 2^32 - 1 modules. O(word).
    void build(const ModuleTable& modules, std::span<const ModuleId> word);

    /// The neighbour towards the root: past complete branches, ignored modules and the brackets that hold the
    /// module. Like all of these: a position in the word, or `none`; requires a grammar that asks for it.
    std::uint32_t before(std::uint32_t position) const { return before_[position]; }
    /// The neighbour away from the root, on the same axis: past branches and ignored modules. For a `[`, the
    /// first such module of its branch.
    std::uint32_t after(std::uint32_t position) const { return after_[position]; }
    /// The `[` of the first branch between a module and the one after it. For a `[`, of the first in its
    /// branch.
    std::uint32_t branch(std::uint32_t position) const { return branch_[position]; }
    /// The `[` of the branch beside the one that begins here.
    std::uint32_t next_branch(std::uint32_t position) const { return next_branch_[position]; }

  private:
    enum class Role : std::uint8_t { seen, ignored, open, close };

    void link_before(const ModuleTable& modules, std::span<const ModuleId> word);
    void link_after(const ModuleTable& modules, std::span<const ModuleId> word);

    std::vector<Role> roles_; ///< of the symbols
    bool has_left_ = false;
    bool has_right_ = false;
    bool has_branches_ = false; ///< in right contexts
    std::vector<std::uint32_t> before_, after_, branch_, next_branch_;
    std::vector<std::uint32_t> open_;
};

/// Matches the contexts of productions against one word after another.
class ContextMatcher {
  public:
    /// Both must outlive this.
    ContextMatcher(const LsysGrammar& grammar, const ModuleTable& modules);

    /// Sets the word for matches(). Requires what ContextLinks::build() does; the word must stay.
    void look_at(std::span<const ModuleId> word);

    /// The modules next to one towards the root and away from it, as ContextLinks says; `none` for the ids of
    /// what is not there. Each requires a rule with such a context.
    ModuleId before(std::uint32_t position) const { return module_at(links_.before(position)); }
    ModuleId after(std::uint32_t position) const { return module_at(links_.after(position)); }

    /// Whether what follows the predecessor of a rule of the grammar, and its contexts, match around a module
    /// that its predecessor matches. If so, adds the modules that they match to `bound`, in the order of
    /// LsysRule::variables. What follows stands side by side; the contexts lie around all of it. A pattern in
    /// brackets matches the first branch that begins so and lies beyond those that earlier patterns match;
    /// branches without a pattern are passed over. For all modules of a word together O(word * pattern).
    bool matches(const LsysRule& rule, std::uint32_t position, ModuleString& bound);

  private:
    struct Item {
        SymbolId symbol = 0;
        std::uint16_t arity = 0;
        std::uint32_t beyond = 0; ///< of a `[`: the item after its `]`; 0: not a bracket
    };
    struct Range {
        std::uint32_t begin = 0;
        std::uint32_t end = 0;
    };
    struct KnownBranch {
        std::uint32_t item;
        std::uint32_t from;
        std::uint32_t found; ///< or none
    };

    ModuleId module_at(std::uint32_t position) const {
        return position == ContextLinks::none ? ContextLinks::none : word_[position];
    }
    Range compile(const std::vector<LsysPattern>& right);
    bool fits(std::uint32_t position, SymbolId symbol, std::uint16_t arity) const;
    bool match_following(const LsysRule& rule, std::uint32_t position, ModuleString& bound) const;
    bool match_left(const std::vector<LsysPattern>& left, std::uint32_t position, ModuleString& bound) const;
    bool match_right(Range items, std::uint32_t position, ModuleString& bound);
    std::uint32_t find_branch(std::uint32_t item, std::uint32_t from, ModuleString& bound);
    bool begins_so(std::uint32_t item, std::uint32_t branch, ModuleString& bound);
    std::optional<std::uint32_t> known_branch(std::uint32_t item, std::uint32_t from) const;
    void remember(std::uint32_t item, std::uint32_t from, std::uint32_t to, std::uint32_t found);
    void forget();

    const LsysGrammar& grammar_;
    const ModuleTable& modules_;
    ContextLinks links_;
    std::vector<Range> right_; ///< of the rules, in items_
    std::vector<Item> items_;
    std::span<const ModuleId> word_;
    /// Results of find_branch() for modules that are ignored themselves: many of these may look at the same
    /// branches.
    std::vector<KnownBranch> known_;
    IdTable known_ids_;
    bool remember_ = false;
};

} // namespace graftal
