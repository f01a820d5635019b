#include "runtime/export/equal_nodes.h"

#include <algorithm>
#include <bit>
#include <functional>
#include <vector>

#include "compiler/support/id_table.h"

namespace graftal {

namespace {

/// A zero is one number, whatever its sign.
std::uint64_t mixed_number(std::uint64_t hash, double number) {
    return mixed(hash, std::bit_cast<std::uint64_t>(number + 0.0));
}

std::uint64_t mixed_vector(std::uint64_t hash, Vec3 vector) {
    for (int axis = 0; axis < 3; ++axis)
        hash = mixed_number(hash, vector[axis]);
    return hash;
}

std::uint64_t hash_of(const SceneNode& node) {
    std::uint64_t hash = mixed(std::hash<std::string>()(node.name), node.parts.size());
    if (node.shape) {
        hash = mixed(hash, *node.shape);
        hash = mixed_vector(hash, node.look.tint.premultiplied);
        if (node.look.material) hash = mixed(hash, *node.look.material);
    }
    for (const ScenePart& part : node.parts) {
        hash = mixed(hash, part.node);
        for (int column = 0; column < 3; ++column)
            hash = mixed_vector(hash, part.node_from_part.linear[column]);
        hash = mixed_vector(hash, part.node_from_part.translation);
    }
    return hash;
}

/// Looks are resolved: a part has no tint and no material of its own.
bool are_equal(const SceneNode& a, const SceneNode& b) {
    const auto same_part = [](const ScenePart& one, const ScenePart& other) {
        return one.node == other.node && one.node_from_part == other.node_from_part &&
               one.colour == other.colour;
    };
    const SceneLook &look = a.look, &other = b.look;
    return a.name == b.name && a.shape == b.shape && look.tint == other.tint &&
           look.inherited == other.inherited && look.material == other.material &&
           look.turns == other.turns && look.colourless == other.colourless &&
           std::ranges::equal(a.parts, b.parts, same_part);
}

} // namespace

void unite_equal_nodes(UnfoldedScene& scene) {
    IdTable known;
    std::vector<SceneId> first(scene.nodes.size()); // by node: the first that is equal
    for (const SceneId id : scene.masters_first) {
        for (ScenePart& part : scene.nodes[id].parts)
            part.node = first[part.node];
        first[id] = known.find_or_add(hash_of(scene.nodes[id]), id, [&](std::uint32_t other) {
            return are_equal(scene.nodes[id], scene.nodes[other]);
        });
    }
    scene.root = first[scene.root];
    sort_masters_first(scene);
}

} // namespace graftal
