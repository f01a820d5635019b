#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "compiler/editing/document.h"
#include "compiler/editing/words.h"

namespace graftal {

/// The surroundings of a place in a text.
struct Place {
    /// Where words have their meaning there, the likeliest first; empty in comments, file names and texts
    /// of no language of ours.
    std::vector<WordPlace> where;
    bool string = false;    ///< of modules of an L-system: each character is a word
    bool begins = false;    ///< a statement or a line may begin there
    bool value = false;     ///< a number may stand there
    std::string_view after; ///< the word or symbol before, without a colon; "" at the beginning
    /// The name, or symbol of a string, at the place or right before it; empty where there is none.
    Span word;
};

/// Looks at a place between two bytes of the text, broken texts too. Requires offset <= size of the text.
/// O(text).
Place place_at(const Document& document, std::uint32_t offset);

} // namespace graftal
