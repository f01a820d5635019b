#pragma once

#include "compiler/detail/graph/detail_graph.h"

namespace graftal {

/// Sets the colours of proxies: with the node's finish they scatter as much light as what is seen below the
/// node does with the finishes that it has. A leaf that scatters twice as much as the bark beside it counts
/// twice. Parts that inherit their finish are taken to have the node's. No channel is above 1.
///
/// Requires set_finishes(); weighs as that. Sets none where the finish scatters no light.
void set_lit_colours(DetailGraph& cut);

} // namespace graftal
