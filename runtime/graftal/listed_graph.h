#pragma once

#include <optional>

#include "compiler/graph/graph.h"
#include "compiler/support/status.h"
#include "runtime/graftal/model.h"

namespace graftal::v1 {

/// The graph as the library shows it; the parts of runs are instances like others. Nothing, with a failed
/// status, where it has more than 10^7 instances.
std::optional<ObjectGraph> listed_graph(const graftal::Graph& graph, Status& status);

} // namespace graftal::v1
