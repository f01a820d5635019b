#pragma once

#include <array>
#include <functional>
#include <initializer_list>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "compiler/analysis/contraction.h"
#include "compiler/graph/components.h"
#include "compiler/graph/graph.h"

// Models for the tests of the analyses, made by hand.

namespace graftal::test {

inline Object named(std::string name) {
    Object object;
    object.name = std::move(name);
    return object;
}

inline std::string numbered(const char* letter, std::size_t number) {
    std::string name = letter;
    return name.append(std::to_string(number));
}

inline Instance instance(ObjectId master, const Affine& place) {
    Instance result;
    result.master = master;
    result.parent_from_child = place;
    return result;
}

inline Affine scaled(double factor, Vec3 offset) {
    return {Mat3(factor), offset};
}

/// x' = a x + b y + e, y' = c x + d y + f, in the plane z = 0; z shrinks by sqrt|det| as the front-end has
/// it.
inline Affine plane_map(double a, double b, double c, double d, double e, double f) {
    Affine map;
    map.linear = Mat3(a, c, 0, b, d, 0, 0, 0, std::sqrt(std::abs(a * d - b * c)));
    map.translation = {e, f, 0};
    return map;
}

inline Affine linear_map(double a, double b, double c, double d) {
    return plane_map(a, b, c, d, 0, 0);
}

/// One object that holds itself under each map.
inline Graph ifs(const std::vector<Affine>& maps) {
    Graph graph;
    Object object = named("all");
    for (const Affine& map : maps)
        object.instances.push_back(instance(0, map));
    graph.root = graph.add(std::move(object));
    return graph;
}

/// A digraph of `size` objects o0, o1, ... with an instance for each edge.
struct Edge {
    ObjectId from;
    ObjectId to;
    Affine place;
};

inline Graph digraph(std::size_t size, const std::vector<Edge>& edges) {
    Graph graph;
    for (std::size_t i = 0; i < size; ++i)
        graph.add(named(numbered("o", i)));
    for (const Edge& edge : edges)
        graph.objects[edge.from].instances.push_back(instance(edge.to, edge.place));
    return graph;
}

/// Maps at the corners of [-1,1]^dimension that halve, each followed by all but itself; a root above them.
inline Graph pound_sign(int dimension) {
    Graph graph;
    const unsigned count = 1u << dimension;
    std::vector<Affine> maps;
    for (unsigned corner = 0; corner < count; ++corner) {
        Vec3 offset(0.0);
        for (int axis = 0; axis < dimension; ++axis)
            offset[axis] = (corner >> axis & 1u) != 0 ? 0.5 : -0.5;
        maps.push_back(scaled(0.5, offset));
    }
    Object root = named("pound_sign");
    for (unsigned i = 0; i < count; ++i)
        root.instances.push_back(instance(i + 1, Affine{}));
    graph.root = graph.add(std::move(root));
    for (unsigned i = 0; i < count; ++i) {
        Object object = named(numbered("w", i));
        for (unsigned j = 0; j < count; ++j)
            if (i != j) object.instances.push_back(instance(j + 1, maps[i]));
        graph.add(std::move(object));
    }
    return graph;
}

inline std::vector<Affine> sierpinski_triangle() {
    const double half = std::numbers::sqrt3 / 4;
    return {scaled(0.5, {0, 0.5, 0}), scaled(0.5, {-half, -0.25, 0}), scaled(0.5, {half, -0.25, 0})};
}

inline std::vector<Affine> sierpinski_tetrahedron() {
    return {scaled(0.5, {0.5, 0.5, 0.5}), scaled(0.5, {0.5, -0.5, -0.5}), scaled(0.5, {-0.5, 0.5, -0.5}),
            scaled(0.5, {-0.5, -0.5, 0.5})};
}

inline std::vector<Affine> menger_maps() {
    std::vector<Affine> maps;
    for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z)
                if ((x == 0) + (y == 0) + (z == 0) < 2)
                    maps.push_back(scaled(1.0 / 3, Vec3(x, y, z) * (2.0 / 3)));
    return maps;
}

/// The sponge as a digraph of its 20 maps, as a front-end with a control digraph makes it.
inline Graph menger_digraph() {
    const std::vector<Affine> maps = menger_maps();
    std::vector<Edge> edges;
    for (ObjectId i = 0; i < maps.size(); ++i)
        for (ObjectId j = 0; j < maps.size(); ++j)
            edges.push_back({i, j, maps[i]});
    return digraph(maps.size(), edges);
}

inline std::vector<Affine> barnsley_fern() {
    return {plane_map(0, 0, 0, .16, 0, 0), plane_map(.85, .04, -.04, .85, 0, 1.6),
            plane_map(.2, -.26, .23, .22, 0, 1.6), plane_map(-.15, .28, .26, .24, 0, .44)};
}

inline std::vector<Affine> twin_dragon() {
    return {plane_map(.5, -.5, .5, .5, 0, 0), plane_map(.5, -.5, .5, .5, 1, 0)};
}

inline std::vector<Affine> heighway_dragon() {
    return {plane_map(.5, -.5, .5, .5, 0, 0), plane_map(-.5, -.5, .5, -.5, 1, 0)};
}

inline std::vector<Affine> levy_curve() {
    return {plane_map(.5, -.5, .5, .5, 0, 0), plane_map(.5, .5, -.5, .5, .5, .5)};
}

/// A cycle through `size` objects, each placed in the one before by `map(i)`.
inline Graph long_cycle(std::size_t size, const std::function<Affine(std::size_t)>& map) {
    std::vector<Edge> edges;
    for (std::size_t i = 0; i < size; ++i)
        edges.push_back({static_cast<ObjectId>(i), static_cast<ObjectId>((i + 1) % size), map(i)});
    return digraph(size, edges);
}

} // namespace graftal::test
