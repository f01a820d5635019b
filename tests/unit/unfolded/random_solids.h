#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <utility>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "compiler/graph/path.h"
#include "tests/unit/unfolded/models.h"

// Random intersections and differences, and the points that lie in them.

namespace graftal::test {

inline bool lies_in(const Primitive& primitive, Vec3 p) {
    const double across = std::hypot(p.x, p.z);
    switch (primitive.kind()) {
    case PrimitiveKind::sphere:
        return glm::length(p) < 1;
    case PrimitiveKind::cube:
        return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) < 1;
    case PrimitiveKind::plane:
        return p.y < 0;
    case PrimitiveKind::cylinder:
        return p.y > 0 && p.y < 1 && across < 1;
    case PrimitiveKind::cone:
        return p.y > 0 && across < 1 - p.y;
    case PrimitiveKind::frustum:
        return p.y > 0 && p.y < 1 && across < 1 - p.y * (1 - primitive.steps() / double{frustum_steps});
    case PrimitiveKind::torus:
        return std::hypot(across - 1, p.y) < 0.25;
    default:
        ADD_FAILURE() << "no rule for " << name_of(primitive);
        return false;
    }
}

/// The plain meaning of a graph: the points that lie in what is drawn of it (graph.h).
class Membership {
  public:
    explicit Membership(const Graph& graph) : graph_(graph), components_(strong_components(graph)) {}

    bool operator()(Vec3 point, std::uint32_t steps) const { return holds(graph_.root, steps, point); }

  private:
    bool holds(ObjectId id, std::uint32_t steps, Vec3 point) const {
        const Object& object = graph_.objects[id];
        if (object.primitive) return lies_in(*object.primitive, point);
        const bool ended = components_.unending[id] && steps == 0;
        bool all = true, any = false;
        for (std::size_t i = 0; i < object.instances.size(); ++i) {
            const Instance& instance = object.instances[i];
            if (ended && components_.unending[instance.master]) continue;
            const std::uint32_t left = steps - levels_of(instance, components_);
            const bool in = holds(instance.master, left, inverse(instance.parent_from_child)(point));
            any = any || in;
            all = all && (object.combination == Combination::subtract && i > 0 ? !in : in);
        }
        return object.is_combined() ? all : any;
    }

    const Graph& graph_;
    const Components components_;
};

class RandomSolids {
  public:
    explicit RandomSolids(std::uint64_t seed) : random_(seed) {}

    Graph graph() {
        Graph graph = empty_graph();
        const ObjectId whole = combined(graph, 1 + below(3));
        place(graph, graph.root, whole, placement(0.5));
        return graph;
    }

    double unit() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
    Vec3 vector() { return {unit(), unit(), unit()}; }

  private:
    std::uint32_t below(std::uint32_t count) { return static_cast<std::uint32_t>(random_() % count); }

    Affine placement(double away) {
        Vec3 scale;
        for (int i = 0; i < 3; ++i)
            scale[i] = std::exp(0.5 * unit()) * (below(4) == 0 ? -1 : 1);
        if (below(2) == 0) scale = Vec3(scale.x);
        return Affine::translate(away * vector()) * Affine::rotate(glm::normalize(vector()), 180 * unit()) *
               Affine::scale(scale);
    }

    ObjectId object(Graph& graph, Combination combination) {
        Object object;
        object.name = "o" + std::to_string(graph.objects.size());
        object.combination = combination;
        return graph.add(std::move(object));
    }

    ObjectId solid(Graph& graph, std::uint32_t depth) {
        if (depth == 0) return primitive(graph);
        switch (below(4)) {
        case 0: {
            const ObjectId id = object(graph, Combination::unite);
            for (std::uint32_t i = 0; i < 2 + below(2); ++i)
                place(graph, id, solid(graph, depth - 1), placement(0.8));
            return id;
        }
        case 1:
            return recursive(graph);
        default:
            return combined(graph, depth);
        }
    }

    ObjectId primitive(Graph& graph) {
        constexpr PrimitiveKind kinds[] = {PrimitiveKind::sphere, PrimitiveKind::cube,
                                           PrimitiveKind::cylinder, PrimitiveKind::cone,
                                           PrimitiveKind::torus};
        const std::uint32_t kind = below(6);
        return graph.primitive(kind < 5 ? Primitive(kinds[kind]) : Primitive(PrimitiveKind::frustum, 64));
    }

    /// A primitive and smaller copies of all of it.
    ObjectId recursive(Graph& graph) {
        const ObjectId id = object(graph, Combination::unite);
        place(graph, id, primitive(graph), placement(0.3));
        for (std::uint32_t i = 0; i < 2; ++i)
            place(graph, id, id,
                  Affine::translate(0.9 * vector()) * Affine::rotate(glm::normalize(vector()), 90 * unit()) *
                      Affine::scale(Vec3(0.5)));
        return id;
    }

    ObjectId combined(Graph& graph, std::uint32_t depth) {
        const ObjectId id = object(graph, below(3) ? Combination::subtract : Combination::intersect);
        place(graph, id, solid(graph, depth - 1), placement(0.2));
        for (std::uint32_t i = 0; i < 1 + below(3); ++i) {
            const bool half_space = below(4) == 0;
            place(graph, id, half_space ? graph.primitive(PrimitiveKind::plane) : solid(graph, depth - 1),
                  placement(0.7));
        }
        return id;
    }

    std::mt19937_64 random_;
};

} // namespace graftal::test
