#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/graph/primitive.h"

namespace graftal {

/// The part of a text that decides which words have a meaning there.
enum class WordPlace : std::uint8_t {
    lsys_file, ///< outside of blocks
    rifs_file,
    inst_file,
    lsys_block,
    rifs_block,
    rifs_map,
    rifs_part, ///< behind `condense` and `terminal`
    orbit,     ///< and its maps
    inst_body,
    ink,
    camera,
    light,
    background,
    ground,
    material,
    sky,
    film,
    haze,
    value,       ///< functions and constants of expressions
    turtle,      ///< symbols of strings
    primitive,   ///< and what may be placed in their stead
    environment, ///< of an L-system
};

/// A word of the languages, and what it means.
struct Word {
    std::string_view word;
    std::string_view form; ///< how it is written: "scale: x, y, z"
    std::string_view doc;  ///< a sentence or two, as Markdown
};

/// The words that the parsers know at a place, in the order of their tables.
std::vector<std::string_view> words_in(WordPlace place);

/// The meaning of a word at a place: null where it has none there. Each word of words_in() has one. This is
/// the one table of such texts; docs/language.md has the same sentences where it lists symbols and shapes.
const Word* word_in(WordPlace place, std::string_view word);

/// The words of all places where these documents may be asked for, for tests.
std::vector<WordPlace> all_word_places();

} // namespace graftal
