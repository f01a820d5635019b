#pragma once

#include <memory>

#include "compiler/analysis/bounding.h"
#include "compiler/analysis/contraction.h"
#include "compiler/detail/prepare.h"
#include "compiler/graph/graph.h"

namespace graftal::test {

/// A graph with nothing but a root; add objects, then instances of them to it.
inline Graph empty_graph() {
    Graph graph;
    graph.root = graph.add({"root", {}, {}, {}, {}});
    return graph;
}

inline void place(Graph& graph, ObjectId user, ObjectId master, const Affine& map, const Tint& tint = {}) {
    Instance instance;
    instance.master = master;
    instance.parent_from_child = map;
    instance.tint = tint;
    graph.objects[user].instances.push_back(instance);
}

inline std::shared_ptr<const PreparedGraph> prepared(const Graph& graph, const DetailOptions& options) {
    const Components components = strong_components(graph);
    const auto bounds = bound_objects(graph, components, decide_contraction(graph, components));
    return std::make_shared<const PreparedGraph>(
        prepare_graph(graph, components, bounds, options.preparing()));
}

} // namespace graftal::test
