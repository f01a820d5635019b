#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/lower/module_table.h"
#include "compiler/lower/turtle_command.h"
#include "compiler/support/affine.h"
#include "compiler/support/diagnostics.h"
#include "compiler/syntax/expression_code.h"
#include "compiler/syntax/lsys_ast.h"

// An L-system between its tree and its derivation: symbols numbered, names looked up, expressions compiled.

namespace graftal {

/// What a production serves.
enum class RuleKind : std::uint8_t {
    produce,   ///< a derivation step
    decompose, ///< applied after each step, and to the axiom, until nothing is left to decompose
    interpret, ///< applied when drawing, again and again
};
inline constexpr std::size_t rule_kind_count = 3;

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
    LsysPattern predecessor;
    std::vector<LsysPattern> left;  ///< has no brackets
    std::vector<LsysPattern> right; ///< brackets are balanced
    /// The names that expressions may use: of the predecessor, then of the left context, then of the right.
    std::vector<std::string_view> variables;
    std::optional<ExpressionCode> condition;
    std::optional<ExpressionCode> probability;
    std::vector<LsysTemplate> successor;

    bool has_context() const { return !left.empty() || !right.empty(); }
};

struct LsysGrammar {
    const LsysBlock* source = nullptr; ///< must outlive the grammar
    Environment lets;
    std::vector<std::string> symbols;    ///< as strings write them; a model is `~NAME`
    std::vector<TurtleCommand> commands; ///< of the symbols
    std::vector<Span> first_uses;        ///< of the symbols
    std::vector<LsysTemplate> axiom;
    std::vector<LsysRule> rules;
    /// The rules that may rewrite a symbol, of one kind, in the order in which they are tried: those with
    /// contexts first, else as the text has them (ABOP, section 1.8).
    std::array<std::vector<std::vector<std::uint32_t>>, rule_kind_count> rules_of;
    std::vector<bool> ignored; ///< symbols that contexts look past
    bool has_context = false;
    bool is_stochastic = false;
    bool polygons_cross_branches =
        false; ///< some `{` and its `}` lie in different branches or strings: `[+A{.].C.}`

    double angle_deg = 90;
    double step = 1;
    std::optional<double> width; ///< nothing: automatic
    Vec3 tropism{0, -1, 0};      ///< unit vector that `T` bends towards, in world space
    std::uint64_t seed = 0;
    std::optional<unsigned> steps; ///< nothing: not given, or infinite
    bool infinite = false;

    const std::vector<std::uint32_t>& candidates(RuleKind kind, SymbolId symbol) const {
        return rules_of[static_cast<std::size_t>(kind)][symbol];
    }
    bool has_rules(RuleKind kind, SymbolId symbol) const { return !candidates(kind, symbol).empty(); }
    bool has_rules(RuleKind kind) const;
    /// Whether some symbol has one of these commands.
    bool uses(std::initializer_list<TurtleCommand> wanted) const;
};

/// Derivations of more steps are refused.
inline constexpr unsigned max_derivation_steps = 10'000;

/// Reports all that is wrong without deriving anything: unknown names, values out of range, symbols that
/// nobody knows; warns of modules that mean nothing or that no production fits. `lets`: the values of the
/// file's and the block's `let`s.
std::optional<LsysGrammar> build_grammar(const LsysBlock& block, Environment lets, Diagnostics& diagnostics);

} // namespace graftal
