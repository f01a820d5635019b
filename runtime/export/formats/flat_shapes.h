#pragma once

#include "runtime/export/formats/plane_view.h"

namespace graftal {

/// A leaf as it is seen along a direction, in its own picture.
struct FlatShape {
    enum class Kind { stroke, disc, polygon, triangles };
    Kind kind = Kind::polygon;
    Point2 from{0, 0}, to{0, 0}; ///< of a stroke, 2 wide, with flat ends; where its axis is
    std::vector<Point2> points;  ///< of a polygon its corners; of triangles three each; a disc has radius 1
};

FlatShape flat_shape(const SceneShape& shape, const SeenFrame& seen);

/// The axis of what is long and round and seen from its side.
std::optional<std::array<Point2, 2>> axis_of(const SceneShape& shape, const SeenFrame& seen);

} // namespace graftal
