#pragma once

#include <optional>
#include <string>

#include "compiler/graph/components.h"
#include "compiler/graph/graph.h"

namespace graftal {

/// Most parts of objects that end, written out where others hold them.
inline constexpr std::size_t most_printed_parts = 100'000;

/// The graph as a recurrent iterated function system (Hart 1992, section 3), in `.rifs` text: one block of
/// maps and their control digraph where all sets have one condensation set, else a block for each object that
/// contains itself, whose maps take others. Objects that end are written out as condensation sets. Chances
/// and stated levels are left out. Nothing where the graph is no such system; `why` then says so. Requires a
/// verified graph.
std::optional<std::string> print_rifs(const Graph& graph, const Components& components, std::string& why);

} // namespace graftal
