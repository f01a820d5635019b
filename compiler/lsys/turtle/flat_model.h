#pragma once

#include <optional>
#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/lower/plant.h"

namespace graftal {

/// The area of one side of a flat model under a linear map; nothing of others. A flat model is made of
/// triangles, polygons, meshes that enclose no volume, and solids as thin as a sheet (sheet.h), as blades of
/// leaves are. It has at most 1000 of them.
std::optional<double> flat_area(const Graph& graph, ObjectId root, const Mat3& linear);

/// One side of a flat model, in its own frame.
struct FlatSide {
    std::vector<PlantTriangle> triangles; ///< of sheets halfway between their faces
    double half_thickness = 0;            ///< of its thickest sheet
};

/// The side of such a model; no triangles of others.
FlatSide flat_side(const Graph& graph, ObjectId root);

} // namespace graftal
