#pragma once

#include <string>
#include <vector>

#include "compiler/analysis/contraction.h"
#include "compiler/graph/graph.h"

namespace graftal {

/// The address of a path (zoom/address.h), which find_path() finds in this graph. Steps that come again and
/// again are written once: (a.b)*12.
std::string address_of(const Graph& graph, const std::vector<GraphStep>& path);

} // namespace graftal
