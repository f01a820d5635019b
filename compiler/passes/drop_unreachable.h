#pragma once

#include "compiler/passes/renumbering.h"

namespace graftal {

/// Drops objects and materials that nothing drawn refers to.
/// Ensures: every object is reachable from the root by instances or terminals; order is kept.
Rewritten drop_unreachable(Graph graph);

} // namespace graftal
