#pragma once

// The algebra of paths: what holds at the end of a path from the root, given what held one edge before. All
// walks follow edges by these rules, over the graph's instances and over what is made of them (CutEdge, and
// the tracer's edges).

#include <cstdint>
#include <optional>

#include "compiler/graph/components.h"
#include "compiler/graph/graph.h"
#include "compiler/support/stretch.h"

namespace graftal {

/// The levels that an instance takes (graph.h, "Levels").
inline std::uint32_t levels_of(const Instance& instance, const Components& components) {
    if (instance.levels != levels_of_master) return instance.levels;
    return components.unending[instance.master] ? 1 : 0;
}

/// Whether the master is a part of the object that holds the instance (graph.h, "Levels").
inline bool is_part(const Instance& instance, const Components& components) {
    return instance.levels == 0 && components.unending[instance.master];
}

/// Where a path from the root stands.
struct PathState {
    ObjectId object = 0;
    Affine world_from_object;
    PathTint tint;                      ///< of the whole path, parent in front
    std::optional<MaterialId> material; ///< the one nearest to the end
    std::uint32_t levels = 0;           ///< levels used up by the path
};

/// One instance further.
inline PathState descend(const PathState& path, const Instance& instance, const Components& components) {
    return {instance.master, path.world_from_object * instance.parent_from_child,
            path.tint * PathTint(instance.tint), instance.material ? instance.material : path.material,
            path.levels + levels_of(instance, components)};
}

inline constexpr std::uint32_t unlimited_steps = UINT32_MAX;

/// The levels that are left after an edge. Requires steps >= edge.levels.
template<typename Edge> std::uint32_t steps_below(std::uint32_t steps, const Edge& edge) {
    return steps == unlimited_steps ? steps : steps - edge.levels;
}

/// The norm of a path's map, one edge further; `placed`: the linear part of that map. Norms multiply where
/// the edge is a similarity.
template<typename Edge> double size_below(double size, const Edge& edge, const Mat3& placed) {
    return edge.similarity ? size * edge.stretch : largest_stretch(placed);
}

} // namespace graftal
