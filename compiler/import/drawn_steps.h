#pragma once

#include <string_view>

#include "compiler/import/l_system.h"

namespace graftal {

/// How often a system is rewritten whose file does not say it, and how many lines it then draws.
struct DrawnSteps {
    int steps = 0;
    double lines = 0;
};

/// The most steps, up to 14, that draw at most 8000 lines, but two at least. `drawing`: the symbols that draw
/// a line. Symbols have one character each, and each has one production at most.
DrawnSteps steps_to_draw(const LSystem& system, std::string_view drawing);

} // namespace graftal
