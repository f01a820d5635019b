#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/import/importer.h"

// An L-system of Fractint after it is parsed.

namespace graftal {

/// Symbols that the turtle knows, or that have another meaning.
inline constexpr std::string_view fractint_reserved = "+-/\\@|!c<>][";

/// One symbol of a string, with the number that belongs to it as it is written.
struct FractintSymbol {
    char letter = 0; ///< a small one
    std::string number;
    Span span;
};

using FractintString = std::vector<FractintSymbol>;

struct FractintRule {
    char letter = 0;
    FractintString successor; ///< of all rules for the letter, one after the other
    Span span;
    std::string comment;
};

struct FractintSystem {
    int angle = 0;
    Span angle_span;
    std::string angle_comment;
    FractintString axiom;
    Span axiom_span;
    std::string axiom_comment;
    std::vector<FractintRule> rules;                   ///< in the order of their first lines
    std::vector<std::pair<std::string, Span>> remarks; ///< comments before the first statement
};

/// Whether a number may follow the letter.
bool takes_number(char letter);

/// The system of a block; nothing after an error.
std::optional<FractintSystem> read_fractint_system(const ForeignFile& file, const ForeignModel& model);

/// The system as a model of ours; of no use after an error.
Translation write_fractint_system(const ForeignFile& file, const ForeignModel& model,
                                  const FractintSystem& system);

} // namespace graftal
