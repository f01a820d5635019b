#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/support/diagnostics.h"
#include "compiler/support/source.h"

// Cuts a `.lsys` file into blocks and statements, by its characters: the symbols of module strings are no
// tokens, and `//` and `/*` stand in them for turns.

namespace graftal {

/// The part of a block that a statement stands in.
enum class LsysSection : std::uint8_t { block, interpret, decompose };

/// A statement, cut out but not parsed.
struct LsysStatement {
    LsysSection section = LsysSection::block;
    std::string_view word; ///< the name that it begins with; may be empty
    std::size_t begin = 0;
    std::size_t end = 0;
};

/// `[main] lsys` in a file.
struct LsysHeader {
    std::size_t begin = 0;    ///< of the first word
    std::string_view keyword; ///< `lsys`, or a misspelling of it
    bool is_main = false;
};

struct LsysOutline {
    std::vector<LsysStatement> statements;
    std::size_t end = 0; ///< after the '}', or where the block must have ended
    bool closed = false;
};

/// The words that begin statements of a block, for suggestions.
const std::vector<std::string>& lsys_keywords();
bool is_lsys_keyword(std::string_view word);
/// Whether `modules` may declare a text of letters, digits and '_' that is no longer than max_lsys_symbol.
bool can_name_module(std::string_view text);

/// The size of the arrow, `->` or `-->`, at the beginning of a text; 0 if there is none.
std::size_t lsys_arrow_size(std::string_view text);

/// The name, letters, digits and '_', that a text begins with.
std::string_view lsys_name(std::string_view text);

class LsysScanner {
  public:
    LsysScanner(const SourceMap& sources, FileId file, Diagnostics& diagnostics)
        : text_(sources.text(file)), file_(file), diagnostics_(diagnostics) {}

    std::string_view text() const { return text_; }
    Span span(std::size_t begin, std::size_t end) const {
        return {file_, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)};
    }
    Span span(std::string_view part) const {
        const auto begin = static_cast<std::size_t>(part.data() - text_.data());
        return span(begin, begin + part.size());
    }

    /// The first block at or after a place at file level.
    std::optional<LsysHeader> find_block(std::size_t at) const;
    /// Past white space, line ends and all comments; one that is not closed is an error.
    std::size_t skip_blanks(std::size_t at) const;
    /// Past the comment of any kind at a place, or the place itself. One that is not closed goes to the end.
    std::size_t comment_end(std::size_t place) const;
    /// The statements of the block whose '{' stands before `begin`, `interpret` and `decompose` opened up.
    LsysOutline outline(std::size_t begin) const;

    /// Past the bracket that closes the '(' or '{' at `open`, outside of comments, or nothing if none does
    /// before `end`.
    std::optional<std::size_t> bracket_end(std::size_t open, std::size_t end) const;
    /// The place of the first arrow outside of parentheses and braces from `at` on or, without one, of the
    /// first inside.
    std::optional<std::size_t> find_arrow(std::size_t at, std::size_t end) const;

    /// Reports "expected WHAT, found ..." at a place.
    Diagnostic& expected(std::string_view what, std::size_t at, std::size_t end,
                         std::string_view end_name) const;

  private:
    char at(std::size_t place) const { return place < text_.size() ? text_[place] : '\0'; }
    std::size_t line_end(std::size_t place) const;
    std::size_t skip_spaces(std::size_t place) const;
    bool at_block(std::size_t place) const;
    bool at_misspelt_block(std::string_view word) const;
    bool has_arrow(std::size_t place) const;
    std::size_t enter_section(std::size_t after_word) const;
    void report_second_statement(std::string_view word) const;
    friend class LsysStatementEnd;

    std::string_view text_;
    FileId file_;
    Diagnostics& diagnostics_;
    mutable bool second_statement_said_ = false;
};

} // namespace graftal
