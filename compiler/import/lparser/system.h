#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/import/importer.h"
#include "compiler/import/l_system.h"

// A model of L-Parser after it is parsed.

namespace graftal {

struct LparserColour {
    int index = 0;
    std::array<int, 3> rgb{};
    Span span;
};

struct LparserNumber {
    double value = 0;
    Span span;
    std::string remark;
};

struct LparserSystem {
    bool has_keywords = false;
    LparserNumber recursion{1, {}, {}}, angle{45, {}, {}}, thickness{100, {}, {}};
    std::optional<LparserNumber> least_thickness;
    bool switch_yz = false;
    std::vector<LparserColour> colours;
    LSystem system; ///< each letter has one production; numbers are as they are written
};

/// Whether a word begins a line of Lparser 5.
bool is_lparser_keyword(std::string_view word);

/// The system of a file; nothing after an error.
std::optional<LparserSystem> read_lparser(const ForeignFile& file);

/// The system as a model of ours; of no use after an error.
Translation write_lparser(const ForeignFile& file, const ForeignModel& model, LparserSystem lparser);

} // namespace graftal
