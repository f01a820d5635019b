#include "compiler/graph/refuse_combined.h"

#include <fmt/format.h>

namespace graftal {

bool refuse_combined(const Graph& graph, std::string_view who, Diagnostics& diagnostics) {
    const ObjectId id = first_combined(graph);
    if (id == graph.objects.size()) return false;
    const Object& object = graph.objects[id];
    diagnostics
        .error(object.span, fmt::format("{} cannot show '{}', which is {} of its parts", who, object.name,
                                        object.combination == Combination::intersect ? "the intersection"
                                                                                     : "the difference"))
        .with_hint("draw the model with 'graftal render --engine native', or make the object a union");
    return true;
}

} // namespace graftal
