#pragma once

#include "compiler/passes/renumbering.h"

namespace graftal {

/// Merges objects that unfold to the same thing: the same primitive, or unions of the same instances (as
/// multisets: same transform bits, tint, material, levels, share of the chances, equivalent masters) with the
/// same terminal. Partition refinement from the coarsest partition, so that equal objects merge inside cycles
/// too (Hopcroft 1971; Paige and Tarjan 1987). The object that comes first in the text keeps its name.
/// Ensures: no two objects are equivalent; idempotent. O(E log V) expected.
Rewritten merge_equivalent(Graph graph);

} // namespace graftal
