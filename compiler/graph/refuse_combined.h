#pragma once

#include <string_view>

#include "compiler/graph/graph.h"
#include "compiler/support/diagnostics.h"

namespace graftal {

/// True, after an error, if the graph has an intersection or a difference. `who`: what knows none, such as "a
/// .stl file".
bool refuse_combined(const Graph& graph, std::string_view who, Diagnostics& diagnostics);

} // namespace graftal
