#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "compiler/import/importer.h"
#include "compiler/import/l_system.h"

namespace graftal {

/// An L-system of Fractint after it is parsed.
struct FractintSystem {
    int angle = 0; ///< parts of a full turn
    Span angle_span;
    std::string angle_remark;
    LSystem system; ///< of capitals, except for t; numbers behind symbols are expressions of ours
};

/// Whether one of the symbols stands in a string of the system or has a rule.
bool uses_any(const LSystem& system, std::string_view symbols);

/// The system of a block; nothing after an error.
std::optional<FractintSystem> read_fractint_system(const ForeignFile& file, const ForeignModel& model);

/// The system as a model of ours; of no use after an error.
Translation write_fractint_system(const ForeignFile& file, const ForeignModel& model,
                                  FractintSystem fractint);

} // namespace graftal
