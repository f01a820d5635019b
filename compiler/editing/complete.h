#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "compiler/editing/document.h"

namespace graftal {

struct Completion {
    std::string label;  ///< the word
    std::string kind;   ///< "keyword", "function", "primitive", "symbol", or word_of() a name
    std::string detail; ///< how it is written, and what it means
    std::string text;   ///< to be put in place of what is there
};

struct Completions {
    std::uint32_t from = 0; ///< what is there: from here to the place that was asked about
    std::vector<Completion> items;
};

/// The words and names that may stand at a place and begin with what stands before it, in any letters. Names
/// of the text first, then words in the order of the parsers' tables. Requires offset <= size of the text.
/// O(text).
Completions complete(const Document& document, std::uint32_t offset);

} // namespace graftal
