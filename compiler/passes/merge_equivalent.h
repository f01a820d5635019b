#pragma once

#include <cstdint>
#include <vector>

#include "compiler/passes/renumbering.h"

namespace graftal {

/// Merges objects that unfold to the same thing: the same primitive, or unions of the same instances (as
/// multisets: same transform bits, tint, material, levels, share of the chances, equivalent masters) with the
/// same terminal. Partition refinement from the coarsest partition, so that equal objects merge inside cycles
/// too (Hopcroft 1971; Paige and Tarjan 1987). The object that comes first in the text keeps its name.
/// Ensures: no two objects are equivalent; idempotent. O(E log V) expected.
Rewritten merge_equivalent(Graph graph);

/// Objects by what they unfold to, apart from colours, materials, terminals and chances.
struct ShapeClasses {
    std::vector<std::uint32_t> class_of; ///< by object; numbered by first member
    std::vector<ObjectId> first;         ///< by class: its first member
};
ShapeClasses classes_of_shape(const Graph& graph);

} // namespace graftal
