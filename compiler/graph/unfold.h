#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "compiler/graph/components.h"
#include "compiler/graph/graph.h"

namespace graftal {

/// One drawn thing of an unfolded graph.
struct UnfoldedLeaf {
    std::optional<Primitive> primitive; ///< nothing: `object`, if that is combined, or its fitted proxy
    ObjectId object = 0;                ///< the primitive's own, or the one that is drawn
    Affine world_from_object;           ///< of the primitive, or of that object
    PathTint tint;                      ///< of the whole path
    std::optional<MaterialId> material;
};

/// Visits every leaf of the unfolding to `steps` levels (graph.h, "Levels") depth first, in the order of the
/// instances. Stops and returns false when `visit` does, or before leaf `max_leaves` + 1. The plain
/// definition of what a graph means: tests hold all else to it, and framing looks by it at a model of few
/// levels. It keeps one frame for each object on the path and no children that wait (walk.h): memory
/// O(depth). Requires `steps` if the graph is unending.
bool unfold(const Graph& graph, const Components& components, std::optional<unsigned> steps,
            std::uint64_t max_leaves, const std::function<bool(const UnfoldedLeaf&)>& visit);

} // namespace graftal
