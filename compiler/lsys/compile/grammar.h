#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/environment/environment.h"
#include "compiler/lsys/compile/module_table.h"
#include "compiler/lsys/compile/program.h"
#include "compiler/lsys/parse/ast.h"
#include "compiler/lsys/parse/turtle_command.h"
#include "compiler/support/affine.h"
#include "compiler/support/diagnostics.h"
#include "compiler/syntax/expression_code.h"

// An L-system between its tree and its derivation: symbols numbered, names looked up, expressions compiled.

namespace graftal {

/// The use of a production.
enum class RuleKind : std::uint8_t {
    produce,   ///< a derivation step
    decompose, ///< applied after each step, and to the axiom, until nothing is left to decompose
    interpret, ///< applied when drawing, again and again
};
inline constexpr std::size_t rule_kind_count = 3;

/// The readings of time that a production looks at, as a set. Variables that change are a function of the
/// step, unless the word is derived in order.
using TimeMask = std::uint8_t;
enum TimeBit : TimeMask { reads_step = 1, reads_age = 2, reads_variables = 4 };
/// Readings that make a drawing change between two steps.
inline constexpr TimeMask reads_clock = reads_step | reads_age;

/// A module of a context or predecessor.
struct LsysPattern {
    SymbolId symbol = 0;
    std::uint16_t arity = 0;
};

/// A module of a successor or axiom.
struct LsysTemplate {
    SymbolId symbol = 0;
    std::vector<ExpressionCode> parameters;
};

struct LsysRule {
    const LsysProduction* source = nullptr;
    RuleKind kind = RuleKind::produce;
    LsysPattern predecessor;
    std::vector<LsysPattern> following; ///< side by side behind it, and rewritten with it
    std::vector<LsysPattern> left;      ///< has no brackets
    std::vector<LsysPattern> right;     ///< brackets are balanced
    /// The names that expressions may use: of the predecessor, then of what follows it, then of the left
    /// context, then of the right.
    std::vector<std::string_view> variables;
    /// The meanings of the slots: the variables; `step` and `age`, or nothing where names of the model hide
    /// them; the local values of the blocks; one random number for each draw.
    std::vector<std::string_view> slots;
    TimeMask time = 0;       ///< readings of the time
    std::uint32_t draws = 0; ///< calls of `normal` and `random`
    LsysProgram before;      ///< carried out before the condition is asked; it may set slots
    std::optional<LsysFormula> condition;
    LsysProgram after; ///< carried out before the successor is made
    std::optional<ExpressionCode> probability;
    std::vector<LsysTemplate> successor;
    static constexpr std::uint32_t none = UINT32_MAX;
    /// With a probability: the rule that leaves its module as it is, for what the probabilities leave.
    std::uint32_t stays = none;
    bool keeps = false; ///< it is such a rule: its successor is the module itself, with its birth

    bool has_context() const { return !left.empty() || !right.empty(); }
    /// Whether one module alone does not tell if it fits.
    bool sees_word() const { return has_context() || !following.empty(); }
    /// Modules that it rewrites.
    std::uint32_t length() const { return static_cast<std::uint32_t>(following.size()) + 1; }
    /// Whether equal modules may become different ones.
    bool is_random() const { return probability.has_value() || draws > 0; }
    bool has_blocks() const { return !before.empty() || !after.empty(); }
    /// Whether its expressions see nothing but its variables, in slots and cells.
    bool is_plain() const { return time == 0 && draws == 0 && !has_blocks(); }
    /// Whether it fits, and what it gives, must be found out in the order of the word.
    bool in_order() const {
        return before.sets_cells || after.sets_cells || before.draws_anew || after.draws_anew ||
               (condition && condition->draws > 0);
    }
    std::uint32_t slot_count() const { return static_cast<std::uint32_t>(slots.size()) + draws; }
};

struct LsysGrammar {
    const LsysBlock* source = nullptr; ///< must outlive the grammar
    Environment lets;
    std::vector<std::string> symbols;    ///< as strings write them; a model is `~NAME`
    std::vector<TurtleCommand> commands; ///< of the symbols
    std::vector<Span> first_uses;        ///< of the symbols
    std::vector<LsysTemplate> axiom;
    std::vector<LsysRule> rules;
    std::shared_ptr<const std::deque<LsysProduction>> stay_productions; ///< sources of the last of them
    /// The rules that may rewrite a symbol, of one kind, in the order in which they are tried: those with
    /// contexts first (ABOP, section 1.8), unless the block has it otherwise, else as the text has them.
    std::array<std::vector<std::vector<std::uint32_t>>, rule_kind_count> rules_of;
    std::vector<bool> ignored; ///< symbols that contexts look past
    std::shared_ptr<const CellPlaces> cells = std::make_shared<CellPlaces>(); ///< of the variables
    std::vector<double> first_cells;                                          ///< their first values
    /// Carried out before the axiom, before and after each step, and after all; slots: see step_slots.
    LsysProgram start, start_each, end_each, end;
    std::uint32_t step_draws = 0; ///< calls of chance in these, each with a slot behind those of step_slots
    bool needs_word = false;      ///< some rule sees more of the word than one module, or the next is true
    bool in_order = false;        ///< some rule changes variables, or asks chance, in the order of the word
    bool is_stochastic = false;   ///< some rule is random
    /// The time that the rules of a kind read which may rewrite a symbol.
    std::array<std::vector<TimeMask>, rule_kind_count> time_of;
    /// Symbols whose modules are drawn by their age, or by that of what they are drawn as, or rewritten by
    /// it.
    std::vector<bool> ages;
    bool polygons_cross_branches =
        false; ///< some `{` and its `}` lie in different branches or strings: `[+A{.].C.}`

    double angle_deg = 90;
    double step = 1;
    std::optional<double> width;      ///< nothing: automatic
    std::optional<double> thickness;  ///< of segments, per length: in place of a width
    double thinnest = 0;              ///< then the least width
    std::optional<double> taper;      ///< of widths from a branch to those that leave it
    int skin = 0;                     ///< sides of the skin of limbs; 0: segments are bodies of their own
    Vec3 tropism{0, -1, 0};           ///< unit vector that `T` bends towards, in world space
    std::vector<Vec3> other_tropisms; ///< the same, of the second and all further ones
    std::vector<TropismKind> tropism_kinds; ///< of all; empty: of one that is plain
    Bending bending = Bending::after_segments;
    std::optional<EnvironmentSettings> environment; ///< answers `?E`; without its seed
    std::uint64_t seed = 0;
    std::optional<unsigned> steps; ///< nothing: not given, or infinite
    bool infinite = false;

    const std::vector<std::uint32_t>& candidates(RuleKind kind, SymbolId symbol) const {
        return rules_of[static_cast<std::size_t>(kind)][symbol];
    }
    bool has_rules(RuleKind kind, SymbolId symbol) const { return !candidates(kind, symbol).empty(); }
    bool has_rules(RuleKind kind) const;
    /// Whether rules of any kind rewrite the symbol.
    bool is_rewritten(SymbolId symbol) const;
    TimeMask time(RuleKind kind, SymbolId symbol) const {
        return time_of[static_cast<std::size_t>(kind)][symbol];
    }
    /// The time that all rules of a kind read.
    TimeMask time(RuleKind kind) const;
    /// Whether the drawing of a word changes between two steps.
    bool draws_in_time() const { return (time(RuleKind::interpret) & reads_clock) != 0; }
    /// Whether rules of a kind have random numbers in their successors.
    bool draws(RuleKind kind) const;
    /// Whether rules of a kind give chance a say.
    bool is_random(RuleKind kind) const;
    /// Whether the seed may change what it derives.
    bool asks_chance() const { return is_stochastic || step_draws > 0 || has_queries(); }
    /// Whether the number of steps may change what it derives.
    bool grows() const {
        return has_rules(RuleKind::produce) || has_rules(RuleKind::decompose) || draws_in_time() ||
               has_queries() || !cells->empty();
    }
    /// Whether some symbol is a query, which derivation sets.
    bool has_queries() const {
        return uses({TurtleCommand::ask_place, TurtleCommand::ask_heading, TurtleCommand::ask_up,
                     TurtleCommand::ask_left, TurtleCommand::ask_environment});
    }
    /// Whether some symbol has one of these commands.
    bool uses(std::initializer_list<TurtleCommand> wanted) const;
};

/// The names in programs of steps.
inline constexpr std::array<std::string_view, 1> step_slots = {"step"};

/// Most elements of the arrays of a block in all, and most cells of its variables.
inline constexpr std::uint32_t max_cells = 65'536;

/// Derivations of more steps are refused.
inline constexpr unsigned max_derivation_steps = 10'000;

/// Reports all that is wrong without deriving anything: unknown names, values out of range, symbols that
/// nobody knows; warns of modules that mean nothing or that no production fits. `lets`: the values of the
/// file's and the block's `let`s.
std::optional<LsysGrammar> build_grammar(const LsysBlock& block, Environment lets, Diagnostics& diagnostics);

} // namespace graftal
