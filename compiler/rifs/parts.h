#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

#include "compiler/rifs/ast.h"
#include "compiler/syntax/token_stream.h"

// The pieces of the `.rifs` grammar that stand in more than one place. All of them report what is wrong;
// after `false` or nothing the caller decides where to go on.

namespace graftal {

/// The words that begin an item of a `rifs` block, or another block.
inline constexpr std::array<std::string_view, 9> rifs_item_words = {
    "map", "codes", "follow", "start", "control", "condense", "terminal", "rifs", "main"};
/// The words that begin an item of a map, apart from those of transforms.
inline constexpr std::array<std::string_view, 4> rifs_map_words = {"tint", "material", "probability",
                                                                   "terminal"};

/// True at a word that begins an item of a `rifs` block, or another block.
bool at_rifs_item(const TokenStream& stream);

/// Takes a name, or reports "expected WHAT, found ...". A name may stand on the next line, but not where that
/// line begins another item.
std::optional<Name> parse_rifs_name(TokenStream& stream, std::string_view what);

/// True at `tint` or `material`.
bool at_rifs_look(const TokenStream& stream);
/// Requires at_rifs_look(). A sign that stands close to a number ends the alpha: it begins the next row.
bool parse_rifs_look(TokenStream& stream, RifsLook& look);

/// `condense` or `terminal`, from its keyword on: MASTER, transforms, tint, material.
std::optional<RifsPart> parse_rifs_part(TokenStream& stream);

/// Takes a map from the room, or reports that the file has too many.
bool take_rifs_map(TokenStream& stream, std::size_t& map_room);

} // namespace graftal
