#include "compiler/lower/check_graph.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "compiler/graph/components.h"

namespace graftal {

namespace {

/// A flag for each object: whether it reaches a plane by instances. Masters come first among components.
std::vector<bool> plane_holders(const Graph& graph, const Components& components) {
    std::vector<bool> holds(graph.objects.size(), false);
    for (const std::vector<ObjectId>& members : components.members) {
        const bool any = std::any_of(members.begin(), members.end(), [&](ObjectId id) {
            const Object& object = graph.objects[id];
            return object.primitive == PrimitiveKind::plane ||
                   std::any_of(object.instances.begin(), object.instances.end(),
                               [&](const Instance& instance) { return holds[instance.master]; });
        });
        for (const ObjectId id : members)
            holds[id] = any;
    }
    return holds;
}

} // namespace

bool check_graph(const Graph& graph, Diagnostics& diagnostics) {
    const Components components = strong_components(graph);
    const std::vector<bool> holds_plane = plane_holders(graph, components);
    const std::vector<bool> returns = terminals_that_return(graph, components);
    std::vector<bool> reported(components.members.size(), false);
    bool good = true;
    for (ObjectId id = 0; id < graph.objects.size(); ++id) {
        const Object& object = graph.objects[id];
        const std::uint32_t component = components.component_of[id];
        if (object.terminal && components.unending[object.terminal->master]) {
            diagnostics
                .error(object.terminal->span,
                       fmt::format("the terminal of '{}' does not end: '{}' contains itself", object.name,
                                   graph.objects[object.terminal->master].name))
                .with_hint("a terminal is what is drawn where recursion stops");
            good = false;
        }
        if (returns[id]) {
            diagnostics
                .error(object.terminal->span,
                       fmt::format("the terminal of '{}' leads back to it", object.name))
                .with_hint("a terminal is drawn in place of its object where that is too small to see");
            good = false;
        }
        const bool plane = holds_plane[id] || (object.terminal && holds_plane[object.terminal->master]);
        if (!plane || !components.cyclic[component] || reported[component]) continue;
        reported[component] = true;
        diagnostics.error(object.span, fmt::format("'{}' contains itself and a plane", object.name))
            .with_hint("a plane has no bounds; place it outside of the recursion");
        good = false;
    }
    return good;
}

} // namespace graftal
