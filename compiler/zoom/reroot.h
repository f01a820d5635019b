#pragma once

// Deep zoom. A picture far inside the unfolding is made of a graph with a new root: the few subtrees that
// lie around the focus, placed in coordinates of the picture. They are found on the way down an address
// (neighbourhood.h), so the magnification has no limit for similarities. No coordinate passes through the
// world (Hart and DeFanti's camera in a node's own frame, made a compiler's stage).

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "compiler/analysis/bounding.h"
#include "compiler/graph/components.h"
#include "compiler/graph/graph.h"
#include "compiler/scene/scene.h"
#include "compiler/support/control.h"
#include "compiler/support/diagnostics.h"
#include "compiler/zoom/address.h"
#include "compiler/zoom/magnification.h"
#include "compiler/zoom/near_ways.h"

namespace graftal {

struct ZoomRequest {
    std::optional<Address> at;         ///< alone: the camera is relative to this object's frame
    std::optional<Magnification> zoom; ///< about the address, the point looked at, or the model's middle
    /// With a zoom: the place of the eye, from the point that the zoom is about, in lengths after it. Then
    /// the camera's own places say its direction only. Nothing: the camera looks at the point from as far as
    /// before.
    std::optional<Vec3> eye = {};

    bool active() const { return at || zoom; }
    bool operator==(const ZoomRequest&) const = default;
};

struct Rerooted {
    Graph graph; ///< the old one with one more object, its root
    Components components;
    std::vector<ObjectBounds> bounds;
    /// One more than the model's: the new root is never the one that is cut, so it counts as a level. Its
    /// instances state the levels that lead to their masters.
    std::optional<unsigned> steps;
    View view;
    Magnification zoom;    ///< how much larger than in the world lengths are
    std::size_t depth = 0; ///< instances from the old root to where the new one begins
    NearWays ways; ///< from the old root to the masters of the new root's instances; a plane of the ground,
                   ///< the last instance, has none
};

/// The model that a new root is made from.
struct ZoomModel {
    const Graph& graph;
    const Components& components;
    const std::vector<ObjectBounds>& bounds;
    std::optional<unsigned> steps;
    std::optional<GraphPath> at = {}; ///< where the address leads, if there is one (find_path())
};

/// The view that shows an object by itself, as if its frame were the world; for the root, the whole model.
/// Paths to the object have used up `used_levels` of the model's levels.
using FrameObject = std::function<View(ObjectId object, unsigned used_levels)>;

/// Makes a new root. With a zoom the camera keeps its direction, angle and distance, and looks at the focus;
/// everything is enlarged about it, and the picture has no lens. With an address alone, the frame of its
/// object becomes the world, and `frame_object` makes the picture; only the lights stay as in the model.
/// `look_at`: a point to zoom about. Errors, in `diagnostics`: an address that does not exist or is deeper
/// than the steps; a point with too few digits for the depth; maps that flatten space more than numbers can
/// follow. `control` counts steps down, and parts that are looked at.
std::optional<Rerooted> reroot(const ZoomModel& model, const ZoomRequest& request,
                               const FrameObject& frame_object, const std::optional<Vec3>& look_at,
                               Diagnostics& diagnostics, const Control& control = no_control());

} // namespace graftal
