#pragma once

#include <cstdint>
#include <string>

#include "compiler/support/source.h"

namespace graftal {

/// A number of the root model that LowerOptions::set may replace.
struct ModelParameter {
    enum class Kind : std::uint8_t {
        let,
        inner,   ///< in [0, 1]
        setting, ///< of an L-system, such as its angle
    };

    Kind kind = Kind::let;
    std::string name;
    double value = 0;     ///< as it is set, or else as the text has it
    Span span;            ///< the value in the text
    bool literal = false; ///< the text has a number there, which an editor may replace; else an expression

    bool operator==(const ModelParameter&) const = default;
};

} // namespace graftal
