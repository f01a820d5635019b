#pragma once

#include <optional>
#include <vector>

#include "compiler/analysis/contraction.h"
#include "compiler/session/values.h"
#include "compiler/support/ray.h"

namespace graftal {

/// The first part of a model that a ray meets.
struct MetPart {
    double t = 0;
    Vec3 point{0.0};
    Vec3 normal{0, 1, 0}; ///< of unit length, against the ray; of a part too small to be seen: the ray's
    std::vector<GraphStep> path; ///< from the graph's root
};

/// Follows a ray of the view through the graph, nearest parts first, down to primitives and to parts of less
/// than `least_px` on the picture. Nothing where it meets none, or within `most_looks`
/// at parts. Slow and plain: for
/// the pointer, whose question is which part this is.
std::optional<MetPart> first_part(const ViewedModel& model, const Ray& ray, double least_px,
                                  std::uint64_t most_looks);

/// The map of the object at the path's end, in the graph's space.
Affine world_from_end(const Graph& graph, const std::vector<GraphStep>& path);

/// The object at the path's end.
ObjectId end_of(const Graph& graph, const std::vector<GraphStep>& path);

} // namespace graftal
