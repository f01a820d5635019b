#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "compiler/analysis/bounding.h"
#include "compiler/detail/graph/build_detail_graph.h"
#include "compiler/graph/components.h"
#include "compiler/graph/graph.h"
#include "compiler/passes/pipeline.h"

namespace graftal::test {

/// The pound sign: all maps x -> (x + corner) / 2 over the corners of the square or cube, none twice in a
/// row.
inline Graph pound_sign(int dimensions, bool tinted) {
    Graph graph;
    const int count = 1 << dimensions;
    const ObjectId cube = graph.primitive(PrimitiveKind::cube);
    for (int j = 0; j < count; ++j)
        graph.add({"w" + std::to_string(j), {}, {}, {}, {}});
    Object root{"pound_sign", {}, {}, {}, {}};
    for (int j = 0; j < count; ++j) {
        Vec3 corner(j & 1 ? 1 : -1, j & 2 ? 1 : -1, j & 4 ? 1 : -1);
        if (dimensions == 2) corner.z = 0;
        const Affine w{Mat3(0.5), 0.5 * corner};
        const Tint tint = tinted ? Tint{Rgb(j & 1, (j >> 1) & 1, (j >> 2) & 1), 0.5} : Tint{};
        Object& object = graph.objects[1 + j];
        for (int i = 0; i < count; ++i)
            if (i != j) object.instances.push_back({static_cast<ObjectId>(1 + i), w, tint, {}, {}});
        object.terminal = Instance{cube, w, tint, {}, {}};
        root.instances.push_back({static_cast<ObjectId>(1 + j), {}, {}, {}, {}});
    }
    graph.root = graph.add(std::move(root));
    return graph;
}

/// Sierpinski's gasket of triangles, or of tetrahedra if `solid`.
inline Graph gasket(bool solid) {
    Graph graph;
    std::vector<Vec3> corners = {Vec3(0, 1, 0), Vec3(-std::sqrt(0.75), -0.5, 0),
                                 Vec3(std::sqrt(0.75), -0.5, 0)};
    ObjectId terminal = graph.primitive(PrimitiveKind::triangle);
    if (solid) {
        corners = {Vec3(1, 1, 1), Vec3(1, -1, -1), Vec3(-1, 1, -1), Vec3(-1, -1, 1)};
        const ObjectId face = graph.primitive(PrimitiveKind::triangle);
        Object tetrahedron{"tetrahedron", {}, {}, {}, {}};
        for (int opposite = 0; opposite < 4; ++opposite) {
            // The map that takes the canonical triangle's corners to three of the four.
            std::vector<Vec3> p;
            for (int i = 0; i < 4; ++i)
                if (i != opposite) p.push_back(corners[i]);
            const Vec3 centre = (p[0] + p[1] + p[2]) / 3.0;
            Affine place{Mat3(1.0), centre};
            place.linear[1] = p[0] - centre;
            place.linear[0] = (p[2] - p[1]) / std::sqrt(3.0);
            place.linear[2] = glm::cross(place.linear[0], place.linear[1]) / glm::length(p[0] - centre);
            tetrahedron.instances.push_back({face, place, {}, {}, {}});
        }
        terminal = graph.add(std::move(tetrahedron));
    }
    Object attractor{"gasket", {}, {}, {}, {}};
    const auto self = static_cast<ObjectId>(graph.objects.size());
    for (const Vec3& corner : corners)
        attractor.instances.push_back({self, {Mat3(0.5), 0.5 * corner}, {}, {}, {}});
    attractor.terminal = Instance{terminal, {}, {}, {}, {}};
    graph.root = graph.add(std::move(attractor));
    return graph;
}

/// Boxes by value iteration from below; enough for maps that contract boxes.
inline std::vector<ObjectBounds> bounds_of(const Graph& graph) {
    std::vector<ObjectBounds> bounds(graph.objects.size());
    for (ObjectId id = 0; id < graph.objects.size(); ++id) {
        const auto& primitive = graph.objects[id].primitive;
        if (primitive == PrimitiveKind::cylinder || primitive == PrimitiveKind::cone)
            bounds[id].box = {Vec3(-1, 0, -1), Vec3(1, 1, 1)};
        else
            bounds[id].box = {Vec3(-1), Vec3(1)};
        bounds[id].unbounded = primitive == PrimitiveKind::plane;
    }
    for (int sweep = 0; sweep < 100; ++sweep)
        for (ObjectId id = 0; id < graph.objects.size(); ++id) {
            if (graph.objects[id].primitive) continue;
            Box box;
            for (const Instance& instance : graph.objects[id].instances) {
                box.include(transformed(instance.parent_from_child, bounds[instance.master].box));
                if (bounds[instance.master].unbounded) bounds[id].unbounded = true;
            }
            bounds[id].box = box;
        }
    for (ObjectBounds& b : bounds)
        b.ball = {b.box.centre(), 0.5 * glm::length(b.box.size())};
    return bounds;
}

/// The cut of a graph after the passes for detail.
inline DetailGraph cut_of(const Graph& graph) {
    BoundedGraph passed = run_passes(detail_passes(), {graph, bounds_of(graph)});
    return build_detail_graph(std::move(passed.graph), passed.bounds);
}

} // namespace graftal::test
