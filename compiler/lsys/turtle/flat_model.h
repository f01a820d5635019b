#pragma once

#include <optional>
#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/lower/plant.h"

namespace graftal {

/// The area of one side of a model that is made of at most 1000 triangles and nothing else, as blades of
/// leaves are, under a linear map; nothing of others.
std::optional<double> flat_area(const Graph& graph, ObjectId root, const Mat3& linear);

/// The triangles of such a model, in its own frame; none of others.
std::vector<PlantTriangle> flat_triangles(const Graph& graph, ObjectId root);

} // namespace graftal
