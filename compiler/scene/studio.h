#pragma once

#include <vector>

#include "compiler/scene/scene.h"

namespace graftal {

/// A vector in the camera's axes (right, up, towards the viewer), in world axes.
Vec3 from_camera(const Camera& camera, Vec3 v);

/// The direction towards a key light, in world axes; `v`: in the camera's. Over ground, an eye that looks up
/// does not put it below the horizon.
Vec3 to_key_light(const Camera& camera, Vec3 v, bool over_ground);

/// The light of a solid model that names none: a wide warm sun over the viewer's left shoulder, and a pale
/// sky that is not seen. Requires the camera and the ground of the view.
void light_as_in_studio(View& view);

/// The background of such a picture where there is no ground: grey paper, lighter towards the foot of the
/// picture.
Sky studio_backdrop(const View& view);

/// Air over the ground of such a picture, which hides where the ground ends. Requires the background.
std::optional<Haze> air_over_ground(const View& view, const Box& bounds);

/// The catcher of the model's shade where it has no ground: a disc under it, of the colour that shows the
/// background where nothing stands in the light. Nothing where the eye lies in the bounds or sees no disc
/// from above. Requires lights, sky and background.
std::optional<ShadowCatcher> catcher_below(const View& view, const Box& bounds);

} // namespace graftal
