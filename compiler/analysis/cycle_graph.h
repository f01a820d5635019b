#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compiler/analysis/contraction.h"
#include "compiler/graph/components.h"
#include "compiler/graph/graph.h"

namespace graftal {

/// An instance that stays inside its strong component; `from` holds it, `to` is its master (both local).
struct CycleEdge {
    std::uint32_t from = 0;
    std::uint32_t to = 0;
    GraphStep step;
};

/// One cyclic strong component by itself, its objects renumbered 0 .. size()-1 in the order of its members.
struct CycleGraph {
    const Graph* graph = nullptr;
    std::vector<ObjectId> objects;
    std::vector<CycleEdge> edges;     ///< by `from`, then by the order of the instances
    std::vector<std::uint32_t> first; ///< edges of v: first[v] .. first[v + 1] - 1

    std::uint32_t size() const { return static_cast<std::uint32_t>(objects.size()); }
    std::span<const CycleEdge> edges_of(std::uint32_t v) const {
        return std::span(edges).subspan(first[v], first[v + 1] - first[v]);
    }
    const Affine& transform(const CycleEdge& edge) const {
        return graph->objects[edge.step.object].instances[edge.step.instance].parent_from_child;
    }
};

/// The place of each object among the members of its component.
std::vector<std::uint32_t> places_in_components(const Components& components);

/// O(component). `places` as places_in_components() gives them.
CycleGraph cycle_graph(const Graph& graph, const Components& components,
                       const std::vector<std::uint32_t>& places, std::uint32_t component);

/// The largest magnitude of an eigenvalue.
double spectral_radius(const Mat3& linear);

/// The log of the spectral radius of a product of linear parts along a closed walk (edge numbers, root side
/// first), -infinity for 0. A sum of logs where all parts are similarities, so without rounding worth naming.
double log_spectral_radius(const CycleGraph& cycle, std::span<const std::uint32_t> walk);

/// The ratio of a similarity, or a negative number where the singular values differ by more than 1e-9.
double similarity_ratio(const Mat3& linear);

} // namespace graftal
