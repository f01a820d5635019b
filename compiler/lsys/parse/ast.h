#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/support/source.h"
#include "compiler/syntax/expression.h"
#include "compiler/syntax/names.h"
#include "compiler/syntax/scene_statements.h"

// The tree of a `.lsys` file (docs/language.md). Texts are views of the source, which outlives the tree.

namespace graftal {

/// More modules than this in the strings, predecessors, contexts and lists of one file are refused while
/// parsing.
inline constexpr std::size_t max_lsys_modules = 100'000;
/// More words than this in the parameters, conditions and probabilities of one file are refused.
inline constexpr std::size_t max_lsys_words = 4'000'000;
/// Brackets and braces of a string nest at most this deep.
inline constexpr std::size_t max_lsys_nesting = 256;
/// More parameters of a module, and more names in one production, are refused.
inline constexpr std::size_t max_lsys_parameters = 256;
/// Declared names of modules have at most this many characters.
inline constexpr std::size_t max_lsys_symbol = 64;

/// A module as axioms and successors write it: one character, a declared name, a directive `@x`, or `~` with
/// the name of a model. Brackets and braces are modules too.
struct LsysModule {
    std::string_view symbol;
    std::vector<Expression> parameters;
    std::string_view model; ///< of `~`
    Span span;              ///< with the parameters
};

/// Brackets and braces are balanced.
struct LsysString {
    std::vector<LsysModule> modules;
    Span span; ///< of the keyword or arrow before it
};

/// A module as predecessors and contexts write it: its parameters are names.
struct LsysFormal {
    std::string_view symbol;
    std::vector<Name> parameters;
    Span span;
};

struct LsysCommandArm;

/// A statement of a block that assigns values.
struct LsysCommand {
    enum class Kind : std::uint8_t {
        assign,
        choose,     ///< `if`: the first arm whose condition holds; the last may have none
        loop,       ///< `while`: one arm
        loop_after, ///< `do ... while`: the same
    };

    Kind kind = Kind::assign;
    std::string target;              ///< of `assign`
    std::vector<Expression> indices; ///< of `assign`, if it is an element of an array
    std::optional<Expression> value; ///< of `assign`
    std::vector<LsysCommandArm> arms;
    Span span; ///< of the target or keyword
};

struct LsysCommandArm {
    std::optional<Expression> condition;
    std::vector<LsysCommand> commands;
};

/// `{ ... }`
struct LsysCommands {
    std::vector<LsysCommand> list;
    Span span; ///< with the braces
};

/// `variable NAME = number` or `array NAME[size][size] = number, ...`
struct LsysVariable {
    Name name;
    std::vector<Expression> sizes;  ///< of an array: one or two
    std::vector<Expression> values; ///< of an array: all, row by row, or none
};

/// `label : left < predecessor following > right : {before} condition {after} -> successor : probability`.
struct LsysProduction {
    Name label;                   ///< an empty text if there is none
    std::vector<LsysFormal> left; ///< has no brackets
    LsysFormal predecessor; ///< no brace; a bracket only where `following` or the successor has its other
    std::vector<LsysFormal>
        following;                 ///< side by side behind the predecessor, and rewritten with it; no braces
    std::vector<LsysFormal> right; ///< brackets are balanced
    std::optional<LsysCommands> before;  ///< carried out before the condition is asked
    std::optional<Expression> condition; ///< this and those below have the local values written out
    std::optional<LsysCommands> after;   ///< carried out when the production is applied
    LsysString successor;
    std::optional<Expression> probability;
    std::vector<std::pair<Name, Expression>> locals; ///< of `with`, as they are written
    Span span;                                       ///< from the label or the first module to the arrow
};

/// `angle`, `step`, `width`, `thickness`, `skin` or `seed`.
struct LsysValue {
    Expression value;
    Span span; ///< of the keyword
};

struct LsysSteps {
    std::optional<Expression> value; ///< nothing: `infinite`
    Span span;                       ///< of the keyword
};

/// `ignore` or `consider`: which symbols contexts look past, or at.
struct LsysContextFilter {
    bool consider = false;
    std::vector<Name> symbols; ///< each once
    Span span;                 ///< of the keyword
};

/// `tropism x, y, z [, angle]` or `torque x, y, z`
struct LsysDirection {
    std::vector<Expression> direction; ///< three
    Span span;                         ///< of the keyword
    std::optional<Expression> angle;   ///< of a tropism
    bool twists = false;               ///< a torque
};

/// `bending after segments`, `after moves` or `before moves`.
struct LsysBending {
    bool before = false;
    bool moves = false;
    Span span; ///< of the keyword
};

/// `environment KIND number, ...`
struct LsysEnvironment {
    std::string_view kind;
    std::vector<Expression> numbers;
    Span span; ///< of the kind
};

/// `precedence text` or `precedence contexts`: in which order productions are tried.
struct LsysPrecedence {
    bool by_text = false; ///< else those with contexts come first
    Span span;            ///< of the keyword
};

struct LsysBlock {
    Name name;
    bool is_main = false;
    std::vector<SceneStatement> lets; ///< in the order of the text; all of kind `let` or `inner`
    std::optional<LsysValue> angle;
    std::optional<LsysValue> step;
    std::optional<LsysValue> width;
    std::optional<LsysValue> thickness;
    std::optional<LsysValue> thinnest;
    std::optional<LsysValue> taper;
    std::optional<LsysValue> skin;
    std::optional<LsysValue> seed;
    std::optional<LsysSteps> steps;
    std::optional<LsysContextFilter> filter;
    std::vector<LsysDirection> tropisms;
    std::optional<LsysBending> bending;
    std::vector<LsysEnvironment> environment;
    std::optional<LsysPrecedence> precedence;
    std::vector<Name> colors;  ///< materials of the colour indices 0, 1, 2, ...
    std::vector<Name> modules; ///< declared names, each once
    std::vector<Name> tables;  ///< their names
    std::vector<LsysVariable> variables;
    std::optional<LsysCommands> start, start_each, end_each, end;
    std::optional<LsysString> axiom;
    std::vector<LsysProduction> productions;
    std::vector<LsysProduction> interpret; ///< without contexts, as are those of `decompose`
    std::vector<LsysProduction> decompose;
    bool broken = false; ///< an error lost a part of it
};

/// A whole `.lsys` file.
struct LsysFile {
    FileId file = 0;
    std::vector<UseStatement> uses;
    std::vector<SceneStatement> statements;
    std::vector<LsysBlock> blocks;
};

/// The block that is the model: the one that is marked `main`, else the last; null without blocks.
const LsysBlock* main_block(const LsysFile& tree);

} // namespace graftal
