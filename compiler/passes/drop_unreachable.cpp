#include "compiler/passes/drop_unreachable.h"

#include <optional>
#include <utility>
#include <vector>

#include "compiler/passes/rewrite.h"

namespace graftal {

namespace {

/// Objects that the root leads to, by instances and terminals.
std::vector<bool> reachable_objects(const Graph& graph) {
    std::vector<bool> reached(graph.objects.size(), false);
    std::vector<ObjectId> pending;
    const auto reach = [&](ObjectId id) {
        if (reached[id]) return;
        reached[id] = true;
        pending.push_back(id);
    };
    reach(graph.root);
    while (!pending.empty()) {
        const Object& object = graph.objects[pending.back()];
        pending.pop_back();
        for (const Instance& instance : object.instances)
            reach(instance.master);
        if (object.terminal) reach(object.terminal->master);
    }
    return reached;
}

} // namespace

Rewritten drop_unreachable(Graph graph) {
    std::vector<ObjectId> new_object = compact(graph.objects, reachable_objects(graph));
    graph.root = new_object[graph.root];

    std::vector<bool> used(graph.materials.size(), false);
    for_each_instance(graph, [&](Instance& instance) { instance.master = new_object[instance.master]; });
    for_each_material(graph, [&](MaterialId& material) { used[material] = true; });
    const std::optional<GroundSetting>& ground = graph.settings.ground;
    for (MaterialId id = 0; id < graph.materials.size(); ++id)
        if (ground && ground->material == graph.materials[id].name) used[id] = true;

    const std::vector<std::uint32_t> new_material = compact(graph.materials, used);
    for_each_material(graph, [&](MaterialId& material) { material = new_material[material]; });
    Renumbering renumbering;
    renumbering.origin = origins(new_object, graph.objects.size());
    renumbering.now = std::move(new_object);
    return {std::move(graph), std::move(renumbering)};
}

} // namespace graftal
