#pragma once

#include <cstddef>
#include <optional>
#include <set>
#include <string_view>
#include <vector>

#include "compiler/lsys/parse/ast.h"
#include "compiler/lsys/parse/scanner.h"
#include "compiler/support/diagnostics.h"
#include "compiler/support/source.h"
#include "compiler/syntax/token_stream.h"

namespace graftal {

/// The longer names of modules that a block declares.
class LsysSymbols {
  public:
    /// False if it was declared before.
    bool add(std::string_view name) { return names_.insert(name).second; }
    /// The longest declared name that a text begins with, else its first character.
    std::string_view first_of(std::string_view text) const;

  private:
    std::set<std::string_view> names_;
};

/// State that all statements of a file share.
struct LsysText {
    const SourceMap& sources;
    const LsysScanner& scanner;
    Diagnostics& diagnostics;
    LsysSymbols symbols;
    std::size_t modules_left = max_lsys_modules + 1; ///< 0: too many, which was reported
    std::size_t words_left = max_lsys_words;
    /// Polygons may begin in one string of a block and end in another (ABOP, figure 5.8): the first '{' and
    /// '}' that have no other in their own string.
    std::optional<Span> open_polygon;
    std::optional<Span> closed_polygon;
    bool stray_brace_said = false; ///< a '}' that may have been meant to close the block was reported
    std::size_t lost_braces = 0;   ///< '{' at the ends of lines that were refused: so many '}' are skipped

    /// Reports, at the end of a block, polygons that never end, or that never began.
    void check_polygons();
    /// Tokens of a part of the file; `end_name` is what messages call their end.
    TokenStream tokens(std::size_t begin, std::size_t end, std::string_view end_name);
    /// Reports what is left after a statement's values.
    bool finish(TokenStream& stream);
};

inline constexpr std::string_view lsys_line_end = "the end of the line";

/// Reads the module strings of one statement, from left to right. Reports faults, and goes on where it can.
class LsysStringReader {
  public:
    /// Reads between two places of the file.
    LsysStringReader(LsysText& text, std::size_t begin, std::size_t end)
        : text_(text), scanner_(text.scanner), at_(begin), end_(end) {}

    /// Modules up to '<', '>', ':', '*', an arrow or the end. The readers return false after an error.
    /// `balanced`: square brackets that do not match are an error.
    bool read_modules(std::vector<LsysModule>& modules, bool balanced = true);
    /// Reads modules with names for parameters, as far as read_modules() reads.
    bool read_formals(std::vector<LsysFormal>& modules);
    /// Reads modules without parameters, for `ignore` and `consider`.
    bool read_symbols(std::vector<Name>& symbols);
    /// An expression that goes on to `end`.
    std::optional<Expression> read_expression(std::size_t end, std::string_view end_name);

    /// The place of the next character that counts, past blanks and comments.
    std::size_t position();
    bool at_end() { return position() >= end_; }
    /// Bytes of the arrow that stands here; 0: none does.
    std::size_t arrow_size();
    bool accept(char c);
    void move_to(std::size_t place) { at_ = place; }
    /// Reports "expected WHAT, found ..." at the next character.
    Diagnostic& expected(std::string_view what);

  private:
    struct Raw {
        std::string_view symbol;
        std::string_view model;
        std::optional<Span> parameters; ///< with their parentheses
        Span span;
    };

    bool more();
    bool take(Raw& raw);
    bool take_symbol(Raw& raw);
    bool take_model(Raw& raw);
    bool take_parameters(Raw& raw);
    bool take_room(const Raw& raw);
    bool stray();
    void warn_of_comment();
    template<class Take> bool read(Take take_module);
    bool read_parameters(const Raw& raw, std::vector<Expression>& parameters);
    bool read_names(const Raw& raw, std::vector<Name>& names);
    bool refuse_empty(TokenStream& stream, const Raw& raw);
    std::string_view rest() const { return scanner_.text().substr(at_, end_ - at_); }

    LsysText& text_;
    const LsysScanner& scanner_;
    std::size_t at_;
    std::size_t end_;
    bool warned_ = false;
};

/// Reports square brackets that do not match, unless they need not be balanced, and notes braces that have no
/// other.
template<class Module>
bool check_lsys_brackets(const std::vector<Module>& modules, LsysText& text, bool balanced = true);

/// Square brackets of a string that have no other in it: first those that close, then those that open.
struct LsysBrackets {
    std::size_t closed = 0;
    std::size_t open = 0;

    /// Counts the next symbol.
    void add(std::string_view symbol);
};

template<class Module> LsysBrackets unmatched_brackets(const std::vector<Module>& modules) {
    LsysBrackets brackets;
    for (const Module& module : modules)
        brackets.add(module.symbol);
    return brackets;
}

} // namespace graftal
