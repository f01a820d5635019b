#pragma once

// Texts of tests with a '^' where somebody asks.

#include <string>

#include "compiler/editing/document.h"

namespace graftal::testing {

struct Marked {
    Document document;
    std::uint32_t offset;
};

/// Requires a '^' in the text; the first is taken out. `mark`: another character, for L-systems.
inline Marked marked(const std::string& name, std::string text, char mark = '^') {
    const std::size_t at = text.find(mark);
    text.erase(at, 1);
    return {Document(name, text), static_cast<std::uint32_t>(at)};
}

} // namespace graftal::testing
