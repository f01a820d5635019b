#include "compiler/graph/planes.h"

#include <algorithm>

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

} // namespace graftal
