#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "compiler/import/importer.h"

// A model of L-Parser after it is parsed.

namespace graftal {

struct LparserSymbol {
    char letter = 0;
    std::optional<std::string> number; ///< as it is written
    Span span;
};

using LparserString = std::vector<LparserSymbol>;

struct LparserLine {
    std::string comment; ///< without a statement: a line of its own
    Span span;
};

struct LparserRule {
    char letter = 0;
    LparserString successor;
    Span span;
    std::string comment;
    std::vector<LparserLine> before; ///< lines of comments
};

struct LparserColour {
    int index = 0;
    std::array<int, 3> rgb{};
    Span span;
};

struct LparserNumber {
    double value = 0;
    Span span;
    std::string comment;
};

struct LparserSystem {
    bool has_keywords = false;
    LparserNumber recursion{1, {}, {}}, angle{45, {}, {}}, thickness{100, {}, {}};
    std::optional<LparserNumber> least_thickness;
    bool switch_yz = false;
    LparserString axiom;
    Span axiom_span;
    std::string axiom_comment;
    std::vector<LparserRule> rules; ///< each letter once
    std::vector<LparserColour> colours;
    std::vector<LparserLine> head; ///< comments before the axiom
    std::vector<LparserLine> tail;
};

/// Whether a word begins a line of Lparser 5.
bool is_lparser_keyword(std::string_view word);

/// The system of a file; nothing after an error.
std::optional<LparserSystem> read_lparser(const ForeignFile& file);

/// The system as a model of ours; of no use after an error.
Translation write_lparser(const ForeignFile& file, const ForeignModel& model, const LparserSystem& system);

} // namespace graftal
