#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/support/source.h"

namespace graftal {

/// A statement of Python or L-Py, which may take several lines, and those that are indented below it.
struct LpyLine {
    std::string text; ///< without its comment; line ends are spaces
    std::string comment;
    Span span;
    std::size_t indent = 0;
    std::vector<LpyLine> below;
};

/// The statements of a file in the order of the text, up to what L-Py's editor appends.
std::vector<LpyLine> lpy_lines(std::string_view text, FileId file);

} // namespace graftal
