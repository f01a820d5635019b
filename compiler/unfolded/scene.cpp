#include "compiler/unfolded/scene.h"

#include <algorithm>

#include <fmt/format.h>
#include <glm/common.hpp>

#include "compiler/primitives/tessellate.h"
#include "compiler/primitives/texture_space.h"

namespace graftal {

Rgb SceneLook::colour() const {
    return glm::clamp(tint.over(inherited), 0.0, 1.0);
}

SceneShape UnfoldedScene::shape_for(const Primitive& primitive, double errors_per_unit) const {
    return {primitive, one_mesh ? 0 : fineness(primitive, errors_per_unit)};
}

int UnfoldedScene::fineness(const Primitive& primitive, double errors_per_unit) const {
    return fineness_for(primitive, tolerance_errors / std::max(errors_per_unit, 1e-300));
}

bool sort_masters_first(UnfoldedScene& scene) {
    // Kahn's algorithm, from the root down.
    std::vector<std::uint64_t> users(scene.nodes.size());
    for (const SceneNode& node : scene.nodes)
        for_each_part(scene, node, [&](const ScenePart& part) { ++users[part.node]; });
    std::vector<SceneId>& order = scene.masters_first;
    order.clear();
    for (SceneId id = 0; id < scene.nodes.size(); ++id)
        if (users[id] == 0) order.push_back(id);
    for (std::size_t next = 0; next < order.size(); ++next)
        for_each_part(scene, scene.nodes[order[next]], [&](const ScenePart& part) {
            if (--users[part.node] == 0) order.push_back(part.node);
        });
    std::reverse(order.begin(), order.end());
    return order.size() == scene.nodes.size();
}

BigCount sum_over_leaves(const UnfoldedScene& scene,
                         const std::function<std::uint64_t(const SceneShape&)>& value) {
    std::vector<BigCount> sums(scene.nodes.size());
    for (const SceneId id : scene.masters_first) {
        const SceneNode& node = scene.nodes[id];
        if (node.shape) sums[id] = value(scene.shapes[*node.shape]);
        for_each_part(scene, node, [&](const ScenePart& part) { sums[id] += sums[part.node]; });
    }
    return sums[scene.root];
}

SceneCounts count(const UnfoldedScene& scene) {
    SceneCounts counts;
    counts.leaves = sum_over_leaves(scene, [](const SceneShape&) { return 1; });
    counts.triangles = sum_over_leaves(scene, [](const SceneShape& shape) {
        return tessellated(shape.primitive, shape.fineness).triangles.size();
    });
    counts.vertices = sum_over_leaves(scene, [](const SceneShape& shape) {
        return tessellated(shape.primitive, shape.fineness).vertices.size();
    });
    counts.nodes = scene.nodes.size();
    std::vector<unsigned> depth(scene.nodes.size());
    for (const SceneId id : scene.masters_first)
        for_each_part(scene, scene.nodes[id], [&](const ScenePart& part) {
            ++counts.parts;
            depth[id] = std::max(depth[id], depth[part.node] + 1);
        });
    counts.depth = depth[scene.root];
    return counts;
}

std::string in_words(const BigCount& number) {
    std::string digits = number.str();
    if (digits.size() <= 15) return digits;
    return fmt::format("{}.{}e+{}", digits[0], digits.substr(1, 2), digits.size() - 1);
}

SceneLook look_through(const UnfoldedScene& scene, const SceneLook& look, const SceneNode& node,
                       const ScenePart& part) {
    SceneLook after = look;
    after.descend(look_step(part, &node.mean, scene.materials));
    after.turns = part.turns;
    return after;
}

namespace {

struct WalkFrame {
    const SceneNode* node = nullptr;
    Affine world_from_node;
    SceneLook look;
    std::size_t next = 0;
};

} // namespace

bool walk_leaves(const UnfoldedScene& scene, SceneId from, const Affine& world_from_node,
                 const SceneLook& look, const std::function<bool(const SceneLeaf&)>& visit) {
    const SceneNode& start = scene.nodes[from];
    if (start.shape) return visit({from, *start.shape, world_from_node, look});
    std::vector<WalkFrame> stack{{&start, world_from_node, look}};
    while (!stack.empty()) {
        WalkFrame& frame = stack.back();
        if (frame.node->cell) { // all of its parts are leaves
            bool goes_on = true;
            for_each_part(scene, *frame.node, [&](const ScenePart& part) {
                if (!goes_on) return;
                SceneLook leaf = look_through(scene, frame.look, *frame.node, part);
                leaf.turns = length_in_turns(part.node_from_part.linear);
                goes_on = visit({part.node, *scene.nodes[part.node].shape,
                                 frame.world_from_node * part.node_from_part, leaf});
            });
            if (!goes_on) return false;
            stack.pop_back();
            continue;
        }
        if (frame.next == frame.node->parts.size()) {
            stack.pop_back();
            continue;
        }
        const ScenePart& part = frame.node->parts[frame.next++];
        const SceneNode& node = scene.nodes[part.node];
        const Affine place = frame.world_from_node * part.node_from_part;
        const SceneLook below = look_through(scene, frame.look, *frame.node, part);
        if (node.shape) {
            if (!visit({part.node, *node.shape, place, below})) return false;
        } else {
            stack.push_back({&node, place, below});
        }
    }
    return true;
}

} // namespace graftal
