#include "compiler/graph/planes.h"

#include <algorithm>

namespace graftal {

std::vector<bool> plane_holders(const Graph& graph, const Components& components) {
    std::vector<bool> holds(graph.objects.size(), false);
    for (const std::vector<ObjectId>& members : components.members) {
        const bool any = std::ranges::any_of(members, [&](ObjectId member) {
            const Object& object = graph.objects[member];
            return object.primitive == PrimitiveKind::plane ||
                   std::ranges::any_of(object.instances,
                                       [&](const Instance& instance) { return holds[instance.master]; });
        });
        for (const ObjectId member : members)
            holds[member] = any;
    }
    return holds;
}

} // namespace graftal
