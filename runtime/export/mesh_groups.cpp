#include "runtime/export/mesh_groups.h"

#include <queue>

#include "compiler/primitives/tessellate.h"

namespace graftal {

namespace {

/// Triangles below each node. A node with none is no mesh.
std::vector<double> triangles_below(const UnfoldedScene& scene) {
    std::vector<double> triangles(scene.nodes.size(), 0);
    for (const SceneId id : scene.masters_first) {
        const SceneNode& node = scene.nodes[id];
        if (node.shape) {
            const SceneShape& shape = scene.shapes[*node.shape];
            triangles[id] =
                static_cast<double>(tessellated(shape.primitive, shape.fineness).triangles.size());
        }
        for (const ScenePart& part : node.parts)
            triangles[id] += triangles[part.node];
    }
    return triangles;
}

/// Nodes that lead to held parts.
std::vector<bool> above(const std::vector<bool>& held, const UnfoldedScene& scene) {
    std::vector<bool> leads(scene.nodes.size(), false);
    if (held.empty()) return leads;
    for (const SceneId id : scene.masters_first)
        for (const ScenePart& part : scene.nodes[id].parts)
            if (held[part.node] || leads[part.node]) leads[id] = true;
    return leads;
}

} // namespace

MeshGroups group_meshes(const UnfoldedScene& scene, const GroupOptions& options) {
    const std::vector<double> triangles = triangles_below(scene);
    std::vector<std::size_t> rank(scene.nodes.size()); // a node has a larger rank than those that it holds
    for (std::size_t i = 0; i < scene.masters_first.size(); ++i)
        rank[scene.masters_first[i]] = i;
    const std::vector<bool> must_open = above(options.held, scene);
    // The largest first, and among equals what holds the others: so each node is opened after all that place
    // it, and the number of its places is known.
    const auto later = [&](SceneId a, SceneId b) {
        if (must_open[a] != must_open[b]) return static_cast<bool>(must_open[b]);
        return triangles[a] != triangles[b] ? triangles[a] < triangles[b] : rank[a] < rank[b];
    };
    std::priority_queue<SceneId, std::vector<SceneId>, decltype(later)> closed(later);
    std::vector<double> places(scene.nodes.size(), 0);
    std::vector<bool> met(scene.nodes.size(), false);
    const auto meet = [&](SceneId id, double count) {
        places[id] += count;
        const bool is_new = !met[id] && triangles[id] > 0;
        if (is_new) closed.push(id);
        met[id] = true;
        return is_new;
    };
    meet(scene.root, 1);
    double stored = triangles[scene.root], nodes = 1;
    std::vector<SceneId> opened;
    std::size_t best = 0;
    double least = stored + options.triangles_of_node;
    MeshGroups groups;
    groups.nodes = nodes;
    groups.triangles = stored;
    while (!closed.empty()) {
        const SceneId id = closed.top();
        if (!options.held.empty() && options.held[id]) {
            closed.pop();
            continue;
        }
        if (scene.nodes[id].shape) break; // nothing larger can be opened
        nodes += places[id] * static_cast<double>(scene.nodes[id].parts.size());
        if (nodes > options.most_nodes && !must_open[id]) break;
        closed.pop();
        stored -= triangles[id];
        for (const ScenePart& part : scene.nodes[id].parts)
            if (meet(part.node, places[id])) stored += triangles[part.node];
        opened.push_back(id);
        const double cost = stored + options.triangles_of_node * nodes;
        if (!(cost < least) && !must_open[id]) continue;
        least = cost;
        best = opened.size();
        groups.nodes = nodes;
        groups.triangles = stored;
    }
    std::vector<bool> is_open(scene.nodes.size(), false);
    for (std::size_t i = 0; i < best; ++i)
        is_open[opened[i]] = true;
    groups.is_mesh.assign(scene.nodes.size(), false);
    const auto mark = [&](SceneId id) {
        if (is_open[id] || groups.is_mesh[id] || !(triangles[id] > 0)) return;
        groups.is_mesh[id] = true;
        groups.meshes.push_back(id);
    };
    mark(scene.root);
    for (std::size_t i = 0; i < best; ++i)
        for (const ScenePart& part : scene.nodes[opened[i]].parts)
            mark(part.node);
    return groups;
}

std::vector<MeshPlace> places_of(const UnfoldedScene& scene, const MeshGroups& groups) {
    std::vector<MeshPlace> places, waiting{{scene.root, {}}};
    while (!waiting.empty()) {
        const MeshPlace at = waiting.back();
        waiting.pop_back();
        if (groups.is_mesh[at.mesh]) {
            places.push_back(at);
            continue;
        }
        const std::vector<ScenePart>& parts = scene.nodes[at.mesh].parts;
        for (auto part = parts.rbegin(); part != parts.rend(); ++part)
            waiting.push_back({part->node, at.world_from_mesh * part->node_from_part});
    }
    return places;
}

} // namespace graftal
