#pragma once

// The algebra of paths: what holds at the end of a path from the root, given what held one edge before. All
// walks follow edges by these rules, over the graph's instances and over what is made of them (DetailEdge,
// and the tracer's edges).

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <glm/common.hpp>

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

/// The tints of a path as one, straight again (Hart 1992, eq. (9) and (10)).
inline Tint straight(const PathTint& path) {
    if (!(path.alpha > 0)) return {};
    return {glm::min(path.premultiplied / path.alpha, Rgb(1.0)), std::min(path.alpha, 1.0)};
}

/// One instance further.
inline PathState descend(const PathState& path, const Instance& instance, const Components& components) {
    return {instance.master, path.world_from_object * instance.parent_from_child,
            path.tint * PathTint(instance.tint), instance.material ? instance.material : path.material,
            path.levels + levels_of(instance, components)};
}

/// A colour that depends on the one that it inherits: fixed + open * (that colour). A set of parts has one
/// from afar, weighted by area.
struct MeanColour {
    Rgb fixed{0.0};
    double open = 1;

    Rgb over(Rgb inherited) const { return fixed + open * inherited; }
};

/// The change of looks along an edge.
struct LookStep {
    PathTint tint;
    std::optional<MaterialId> material;
    MeanColour inherits; ///< colour that is inherited below the edge, from that above it
};

/// The one rule of looks: a material gives its colour to all below that names none, and a stand-in takes on
/// the mean colour of the set that it stands for. `set`: that mean colour; null: the edge leads to no
/// stand-in.
template<typename Edge>
LookStep look_step(const Edge& edge, const MeanColour* set, const std::vector<Material>& materials) {
    if (edge.material) return {edge.tint, edge.material, {materials[*edge.material].rgb, 0}};
    return {edge.tint, std::nullopt, set ? *set : MeanColour()};
}

/// The look at the end of a path from the root.
struct Look {
    PathTint tint;
    Rgb inherited{0.8};                 ///< the colour that what names no material shows; at first Material's
    std::optional<MaterialId> material; ///< whose finish it shows

    /// One edge further.
    void descend(const LookStep& step) {
        tint = tint * step.tint;
        inherited = step.inherits.over(inherited);
        if (step.material) material = step.material;
    }
};

/// The colour at the end of a path, as its upper end sees it, in single precision: fixed + open * (what the
/// path ends on).
struct Paint {
    std::array<float, 3> fixed{};
    float open = 1;

    Paint() = default;
    explicit Paint(const MeanColour& colour)
        : fixed{static_cast<float>(colour.fixed.r), static_cast<float>(colour.fixed.g),
                static_cast<float>(colour.fixed.b)},
          open(static_cast<float>(colour.open)) {}
    explicit Paint(const PathTint& tint) : Paint(MeanColour{tint.premultiplied, 1 - tint.alpha}) {}

    /// This paint behind another.
    Paint under(const Paint& front) const {
        Paint seen;
        seen.fixed = {front.fixed[0] + front.open * fixed[0], front.fixed[1] + front.open * fixed[1],
                      front.fixed[2] + front.open * fixed[2]};
        seen.open = front.open * open;
        return seen;
    }
};

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
