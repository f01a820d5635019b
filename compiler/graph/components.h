#pragma once

#include <cstdint>
#include <vector>

#include "compiler/graph/graph.h"

namespace graftal {

/// The strong components of a graph. Numbered so that a component's instances lead to itself or to
/// components of smaller number: masters first.
struct Components {
    std::vector<std::uint32_t> component_of;    ///< by object
    std::vector<std::vector<ObjectId>> members; ///< by component
    std::vector<bool> cyclic;                   ///< by component: holds a cycle (self-instances count)
    std::vector<bool> unending;                 ///< by object: reaches a cycle

    bool any_cycle() const;
};

/// Tarjan's algorithm without recursion: O(objects + instances) whatever the depth of the graph. Terminals
/// are not edges of it.
Components strong_components(const Graph& graph);

/// A flag for each object: whether its terminal leads back to it, by instances and terminals. Such an object
/// would be drawn within itself where it is too small to see, without end. (Terminals of unending objects
/// never do: they end.)
std::vector<bool> terminals_that_return(const Graph& graph, const Components& components);

} // namespace graftal
