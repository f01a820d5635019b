#include "compiler/graph/planes.h"

#include <algorithm>

#include <glm/geometric.hpp>

namespace graftal {

std::vector<bool> plane_holders(const Graph& graph, const Components& components) {
    std::vector<bool> holds(graph.objects.size(), false);
    for (const std::vector<ObjectId>& members : components.members) {
        const bool any = std::ranges::any_of(members, [&](ObjectId member) {
            const Object& object = graph.objects[member];
            const auto held = [&](const Instance& instance) -> bool { return holds[instance.master]; };
            if (object.combination == Combination::intersect)
                return std::ranges::all_of(object.instances, held);
            if (object.combination == Combination::subtract) return held(object.instances.front());
            return object.primitive == PrimitiveKind::plane || std::ranges::any_of(object.instances, held);
        });
        for (const ObjectId member : members)
            holds[member] = any;
    }
    return holds;
}

std::optional<HalfSpace> half_space_under(const Affine& map) {
    // Upright on the images of x and z; below is where y falls, whichever way the map turns.
    const Vec3 across = glm::cross(map.linear[2], map.linear[0]);
    const double area = glm::length(across);
    const double volume = glm::dot(across, map.linear[1]);
    if (!(area > 0) || volume == 0) return std::nullopt;
    const Vec3 up = (volume < 0 ? -1 : 1) / area * across;
    return HalfSpace{up, glm::dot(up, map.translation)};
}

std::optional<HalfSpace> half_space_of(const Graph& graph, const Instance& instance) {
    Affine map = instance.parent_from_child;
    const Object* object = &graph.objects[instance.master];
    // A chain of objects that comes back to itself leads to no plane.
    for (std::size_t most = graph.objects.size(); most > 0 && object->instances.size() == 1; --most) {
        map = map * object->instances.front().parent_from_child;
        object = &graph.objects[object->instances.front().master];
    }
    return object->primitive == PrimitiveKind::plane ? half_space_under(map) : std::nullopt;
}

} // namespace graftal
