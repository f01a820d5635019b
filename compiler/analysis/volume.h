#pragma once

#include <optional>
#include <span>

#include "compiler/analysis/bounding.h"
#include "compiler/graph/components.h"
#include "compiler/graph/graph.h"

namespace graftal {

/// Bounds of the volume of a set. They are equal, rounding aside, where it is known exactly.
struct VolumeRange {
    double least = 0, most = 0;
};

/// The volume that the root's parts enclose together, where none counts twice: of the unfolding to `steps`
/// levels (count_leaves()), or of the limit set without. Exact for parts that lie apart, for what a convex
/// first part of a difference holds whole, and for limits of volume 0. Parts that may overlap count once for
/// `least`, each for `most`. Nothing where a plane has no bounds, and where it would cost over some seconds.
/// Requires the bounds that bound_objects() gives.
std::optional<VolumeRange> volume_range(const Graph& graph, const Components& components,
                                        std::span<const ObjectBounds> bounds, std::optional<unsigned> steps);

} // namespace graftal
