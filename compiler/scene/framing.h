#pragma once

#include <optional>
#include <vector>

#include "compiler/analysis/bounding.h"
#include "compiler/scene/scene.h"

namespace graftal {

/// Extent along an axis of a box, as a share of its largest extent, at or below which there is no depth.
inline constexpr double flat_share = 1e-6;
/// Share below which a model is a figure drawn with thick lines: shown face on as well, but lit as a solid.
inline constexpr double thin_share = 0.06;

/// The axis (0, 1, 2 for x, y, z) along which the box is thinnest; of equally thin ones z, then x, then y.
int thinnest_axis(const Box& bounds);

/// Extent along the thinnest axis over the largest extent; 0 for a point.
double thickness(const Box& bounds);

/// True for what is shown face on: models without depth, and upright ones with little.
bool is_figure(const Box& bounds);

/// `over` taking precedence over `model`, field by field. An angle or a width says which projection is meant.
CameraSetting merge(const CameraSetting& model, const CameraSetting& over);

/// The camera that fulfils the setting and shows the whole of the bounds, or of the outline in them: as
/// near, or as wide, as leaves a margin of 5 % on either side of the tighter dimension. Part of the model
/// may be out of view only in two cases. Either location and angle (or width) are both given, or the eye is
/// so near that it needs more than 90 degrees. The outline of a figure, which the box shows exactly, counts
/// only if the camera is going to be `turning` round it.
Camera frame_camera(const CameraSetting& setting, const Box& bounds, const Outliner& outliner, ImageSize size,
                    bool turning = false);

/// A size of about as many pixels as `size`, in the shape that suits what is seen: of the usual shapes from
/// 16:9 to 9:16 the nearest to the outline's. `size` itself where the setting says how much is seen.
ImageSize shaped_size(const CameraSetting& setting, const Box& bounds, const Outliner& outliner,
                      ImageSize size);

} // namespace graftal
