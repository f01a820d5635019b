#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "compiler/graph/graph.h"
#include "compiler/primitives/tapered.h"

// Points of limit sets, found by plain means, to hold bounds against.

namespace graftal::test {

/// A random point of the surface or inside of a primitive.
inline Vec3 random_point_of(const Primitive& kind, std::mt19937& random) {
    std::uniform_real_distribution<double> unit(0, 1);
    const double angle = 2 * std::numbers::pi * unit(random), s = unit(random), t = unit(random);
    const double half = std::numbers::sqrt3 / 2;
    switch (kind.kind()) {
    case PrimitiveKind::triangle: {
        const double u = std::sqrt(s);
        return (1 - u) * Vec3(0, 1, 0) + u * (1 - t) * Vec3(-half, -.5, 0) + u * t * Vec3(half, -.5, 0);
    }
    case PrimitiveKind::sphere: {
        const double z = 2 * s - 1, r = std::sqrt(1 - z * z);
        return {r * std::cos(angle), r * std::sin(angle), z};
    }
    case PrimitiveKind::cube:
        return {s < .5 ? -1 : 1, t < .5 ? -1 : 1, unit(random) < .5 ? -1 : 1};
    case PrimitiveKind::cylinder:
        return {std::cos(angle), s < .5 ? 0 : 1, std::sin(angle)};
    case PrimitiveKind::cone:
        return {(1 - s) * std::cos(angle), s, (1 - s) * std::sin(angle)};
    case PrimitiveKind::frustum: {
        const double r = 1 - s * (1 - top_radius(kind));
        return {r * std::cos(angle), s, r * std::sin(angle)};
    }
    case PrimitiveKind::torus: {
        const double around = 2 * std::numbers::pi * s, ring = 1 + .25 * std::cos(around);
        return {ring * std::cos(angle), .25 * std::sin(around), ring * std::sin(angle)};
    }
    default: // tests/unit/primitives holds the others to their own surfaces
        break;
    }
    return Vec3(0.0);
}

/// Random points of limit sets, by random paths; large instances are chosen more often, so that the parts
/// fill evenly, or nearly so.
class Sampler {
  public:
    explicit Sampler(const Graph& graph) : graph_(graph), weights_(graph.objects.size()) {
        for (std::size_t id = 0; id < graph.objects.size(); ++id) {
            double sum = 0;
            for (const Instance& part : graph.objects[id].instances) {
                const double stretch = norm(part.parent_from_child.linear);
                weights_[id].push_back(sum += std::clamp(stretch * stretch, .01, 1.0));
            }
        }
    }

    /// Follows a path to a primitive, or until it is in the set to rounding, or for `longest` instances.
    Vec3 point(ObjectId id, std::mt19937& random, int longest = 1000) const {
        std::vector<const Affine*> path;
        Mat3 product(1.0);
        const auto vanished = [&product] {
            double sum = 0;
            for (int column = 0; column < 3; ++column)
                sum += glm::dot(product[column], product[column]);
            return sum < 1e-44;
        };
        while (!graph_.objects[id].primitive && static_cast<int>(path.size()) < longest && !vanished()) {
            const Instance& chosen = graph_.objects[id].instances[choose(id, random)];
            product = product * chosen.parent_from_child.linear;
            path.push_back(&chosen.parent_from_child);
            id = chosen.master;
        }
        const auto primitive = graph_.objects[id].primitive;
        Vec3 result = primitive ? random_point_of(*primitive, random) : Vec3(0.0);
        for (std::size_t i = path.size(); i-- > 0;)
            result = (*path[i])(result);
        return result;
    }

    std::vector<Vec3> points(ObjectId id, std::size_t count, unsigned seed) const {
        std::mt19937 random(seed);
        std::vector<Vec3> result;
        for (std::size_t i = 0; i < count; ++i)
            result.push_back(point(id, random));
        return result;
    }

  private:
    std::size_t choose(ObjectId id, std::mt19937& random) const {
        const std::vector<double>& sums = weights_[id];
        const double left = std::uniform_real_distribution<double>(0, sums.back())(random);
        const auto found = std::upper_bound(sums.begin(), sums.end() - 1, left);
        return static_cast<std::size_t>(found - sums.begin());
    }

    const Graph& graph_;
    std::vector<std::vector<double>> weights_; // by object: running sums over its instances
};

inline Affine random_affine(std::mt19937& random, double size) {
    std::normal_distribution<double> normal(0, size);
    Affine map;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            map.linear[column][row] = normal(random);
    map.translation = {normal(random), normal(random), normal(random)};
    return map;
}

inline std::vector<Vec3> random_points(const Graph& graph, ObjectId id, std::size_t count, unsigned seed) {
    return Sampler(graph).points(id, count, seed);
}

} // namespace graftal::test
