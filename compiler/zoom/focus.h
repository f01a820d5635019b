#pragma once

#include <optional>
#include <vector>

#include "compiler/analysis/bounding.h"
#include "compiler/graph/graph.h"
#include "compiler/zoom/address.h"
#include "compiler/zoom/magnification.h"

namespace graftal {

/// The point that a zoom is about, and the objects on the way to it.
struct Focus {
    GraphPath path;
    std::vector<Vec3> points; ///< the point in the frame of the object before step i; an endless path
                              ///< has those that all further steps repeat
    double error = 0;         ///< in units of the last frame; 0 if the path is endless

    Vec3 at(std::size_t i) const {
        const std::size_t straight = path.steps.size();
        return points[i <= straight || !path.endless() ? i : straight + (i - straight) % path.cycle.size()];
    }
};

/// The limit point of an endless path; of another the centre of the last object's ball.
Focus focus_of_path(const Graph& graph, const std::vector<ObjectBounds>& bounds, GraphPath path);

/// The point, by the parts that it lies in. Pulled back from part to part its digits are used up, unless a
/// point recurs, as the corners and the crossings of a fractal do: the address is periodic then, and the
/// focus exact at every depth.
Focus focus_at_point(const Graph& graph, const std::vector<ObjectBounds>& bounds, Vec3 point);

/// The point of the model that lies nearest to the one given, about; exact at every depth. `zoom` says
/// how deep it is asked for. Of a primitive, where the way ends, it is a point that is farthest towards
/// `to_eye`, a direction in the frame of the root: one that an eye there sees.
Focus focus_near_point(const Graph& graph, const std::vector<ObjectBounds>& bounds, Vec3 point,
                       const Magnification& zoom, Vec3 to_eye);

} // namespace graftal
