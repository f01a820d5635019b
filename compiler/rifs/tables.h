#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "compiler/rifs/ast.h"
#include "compiler/syntax/token_stream.h"

// The two tables of the `.rifs` grammar: rows of codes, and the control digraph. As in parts.h, after
// `false` or nothing the caller decides where to go on.

namespace graftal {

/// Parses the rows of `codes 2d|polar|3d { ... }`, from `codes` on, to the end of `maps`. Rows in error
/// become broken maps, so that their names are known. `map_room` is how many maps the file may still have.
bool parse_rifs_codes(TokenStream& stream, std::vector<RifsMap>& maps, std::size_t& map_room);

/// Parses `control <...>, <...>, <...>`, from `control` on, into the block. False after an error.
bool parse_rifs_control(TokenStream& stream, RifsBlock& block);

/// Parses `follow ...`, from `follow` on.
std::optional<RifsFollow> parse_rifs_follow(TokenStream& stream);

/// Numbers the maps of a block, and makes condensation sets of its rows that map everything to one point: a
/// small ball with their probability and look. Rows stay where a digraph or a start may speak of them, and
/// where the block has no other map. Rows of `codes barycentric` get the block's control points. Call it at
/// the end of the block.
void settle_rifs_rows(RifsBlock& block, Diagnostics& diagnostics);

} // namespace graftal
