#pragma once

#include <optional>
#include <vector>

#include "compiler/graph/components.h"
#include "compiler/graph/graph.h"

namespace graftal {

/// A flag for each object: whether it is a plane, or reaches one by instances. O(graph).
std::vector<bool> plane_holders(const Graph& graph, const Components& components);

/// All points x with dot(up, x) <= height.
struct HalfSpace {
    Vec3 up; ///< of length 1
    double height;
};

/// The image of the half space below a plane; nothing if the map flattens space.
std::optional<HalfSpace> half_space_under(const Affine& map);
/// The half space of an instance that places a plane and nothing else, by however many objects.
std::optional<HalfSpace> half_space_of(const Graph& graph, const Instance& instance);

} // namespace graftal
