#include "compiler/unfolded/levels.h"

#include <algorithm>

namespace graftal {

namespace {

/// Takes apart what is not kept. The root is kept.
std::optional<UnfoldedScene> without(const UnfoldedScene& scene, const std::vector<bool>& kept,
                                     std::size_t most_parts) {
    UnfoldedScene result = scene;
    std::size_t count = 0;
    for (const SceneId id : scene.masters_first) {
        if (!kept[id]) continue;
        std::vector<ScenePart> parts;
        std::vector<ScenePart> waiting(scene.nodes[id].parts.rbegin(), scene.nodes[id].parts.rend());
        while (!waiting.empty()) {
            const ScenePart part = waiting.back();
            waiting.pop_back();
            if (kept[part.node]) {
                if (++count > most_parts) return std::nullopt;
                parts.push_back(part);
                continue;
            }
            const std::vector<ScenePart>& below = scene.nodes[part.node].parts;
            if (waiting.size() + below.size() > most_parts) return std::nullopt;
            for (auto inner = below.rbegin(); inner != below.rend(); ++inner) {
                waiting.push_back(*inner);
                waiting.back().node_from_part = part.node_from_part * inner->node_from_part;
            }
        }
        result.nodes[id].parts = std::move(parts);
    }
    std::erase_if(result.masters_first, [&](SceneId id) { return !kept[id]; });
    return result;
}

} // namespace

std::optional<UnfoldedScene> with_levels(const UnfoldedScene& scene, unsigned levels,
                                         std::size_t most_parts) {
    std::vector<unsigned> height(scene.nodes.size(), 0);
    for (const SceneId id : scene.masters_first)
        for (const ScenePart& part : scene.nodes[id].parts)
            height[id] = std::max(height[id], height[part.node] + 1);
    const unsigned whole = height[scene.root];
    if (whole <= levels) return scene;
    // Heights 0, step, 2 step and so on below the root's make the levels.
    const unsigned step = (whole + levels - 1) / levels;
    std::vector<bool> kept(scene.nodes.size());
    for (SceneId id = 0; id < scene.nodes.size(); ++id)
        kept[id] = id == scene.root || scene.nodes[id].shape || height[id] % step == 0;
    return without(scene, kept, most_parts);
}

} // namespace graftal
