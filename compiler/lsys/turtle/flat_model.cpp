#include "compiler/lsys/turtle/flat_model.h"

#include <numbers>

#include <glm/geometric.hpp>

namespace graftal {

namespace {

constexpr int most_objects = 1000;

/// Calls `visit` with the place of each canonical triangle below an object. False where there is anything
/// else, or too much. `left`: objects that may be looked at.
template<typename Visit>
bool each_triangle(const Graph& graph, ObjectId id, const Affine& place, int& left, const Visit& visit) {
    const Object& object = graph.objects[id];
    if (--left < 0 || object.is_combined() || object.packed) return false;
    if (object.primitive) {
        if (*object.primitive != PrimitiveKind::triangle) return false;
        visit(place);
        return true;
    }
    for (const Instance& part : object.instances)
        if (!each_triangle(graph, part.master, place * part.parent_from_child, left, visit)) return false;
    return true;
}

} // namespace

std::optional<double> flat_area(const Graph& graph, ObjectId root, const Mat3& linear) {
    double sum = 0;
    int left = most_objects;
    const bool flat = each_triangle(graph, root, {linear, Vec3(0.0)}, left, [&](const Affine& place) {
        sum += 0.75 * std::numbers::sqrt3 * glm::length(glm::cross(place.linear[0], place.linear[1]));
    });
    return flat ? std::optional(sum) : std::nullopt;
}

std::vector<PlantTriangle> flat_triangles(const Graph& graph, ObjectId root) {
    constexpr double half_side = std::numbers::sqrt3 / 2;
    std::vector<PlantTriangle> triangles;
    int left = most_objects;
    const bool flat = each_triangle(graph, root, {}, left, [&](const Affine& place) {
        triangles.push_back({place({0, 1, 0}), place({-half_side, -0.5, 0}), place({half_side, -0.5, 0})});
    });
    if (!flat) triangles.clear();
    return triangles;
}

} // namespace graftal
