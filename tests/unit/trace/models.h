#pragma once

#include <memory>
#include <optional>

#include <glm/geometric.hpp>

#include "compiler/analysis/bounding.h"
#include "compiler/analysis/contraction.h"
#include "compiler/detail/prepare.h"
#include "compiler/graph/graph.h"
#include "runtime/trace/model/trace_model.h"

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

/// The model as the engine sees it, from the front and far enough away to see all of it in 640 pixels, or
/// from `eye`.
inline std::unique_ptr<TraceModel> traced(const Graph& graph, const DetailOptions& options,
                                          std::optional<Vec3> eye = {}) {
    const Components components = strong_components(graph);
    const auto bounds = bound_objects(graph, components, decide_contraction(graph, components));
    const Box& box = bounds[graph.root].box;
    View view;
    view.size = {640, 480};
    view.camera.location =
        box.empty() ? Vec3(0, 1, 5) : box.centre() + Vec3(0, 0, 2 * glm::length(box.size()));
    if (eye) view.camera.location = *eye;
    return std::make_unique<TraceModel>(
        std::make_shared<const PreparedCut>(prepare_cut(graph, components, bounds, options.preparing())),
        view, options);
}

/// Four copies of itself at the corners of a tetrahedron, to the limit; the leaf a ball. Where they are
/// smaller than half of it, the set is dust.
inline Graph tetrahedron(double scale = 0.5) {
    Graph graph = empty_graph();
    const ObjectId ball = graph.primitive(PrimitiveKind::sphere);
    const ObjectId self = graph.add({"self", {}, {}, {}, {}});
    for (const Vec3 corner : {Vec3(1, 1, 1), Vec3(1, -1, -1), Vec3(-1, 1, -1), Vec3(-1, -1, 1)})
        place(graph, self, self, Affine::translate(0.5 * corner) * Affine::scale(Vec3(scale)),
              {corner * 0.5 + 0.5, 0.5});
    graph.objects[self].terminal = Instance{ball, {}, {}, {}, {}};
    place(graph, graph.root, self, {});
    return graph;
}

} // namespace graftal::test
