#pragma once

#include <memory>
#include <optional>

#include <glm/geometric.hpp>

#include "runtime/trace/model/trace_model.h"
#include "tests/unit/unfolded/models.h"

namespace graftal::test {

/// The model as the engine sees it, from the front and far enough away to see all of it in 640 pixels, or
/// from `eye`.
inline std::unique_ptr<TraceModel> traced(const Graph& graph, const DetailOptions& options,
                                          std::optional<Vec3> eye = {}) {
    const auto cut = prepared(graph, options);
    const Box& box = cut->bounds;
    View view;
    view.size = {640, 480};
    view.camera.location =
        box.empty() ? Vec3(0, 1, 5) : box.centre() + Vec3(0, 0, 2 * glm::length(box.size()));
    if (eye) view.camera.location = *eye;
    return std::make_unique<TraceModel>(cut, view, options);
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
