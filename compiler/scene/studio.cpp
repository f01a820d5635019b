#include "compiler/scene/studio.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "compiler/scene/backdrop.h"

namespace graftal {

namespace {

/// In the camera's axes: right, up, towards the viewer.
const Vec3 key_direction(-0.70, 0.85, 0.50);
constexpr double key_angle_deg = 5;

/// In sizes of the model: where its shade ends.
constexpr double catcher_reach = 2.2;
/// In distances to the model: where a third of what the air hides is left.
constexpr double clear_distances = 20;
/// A model may float, or an eye look along the plane: then there is no shade to be seen.
constexpr double least_sight_slope = 0.05;

bool holds(const Box& box, Vec3 point) {
    for (int axis = 0; axis < 3; ++axis)
        if (!(box.min[axis] <= point[axis] && point[axis] <= box.max[axis])) return false;
    return true;
}

} // namespace

Vec3 from_camera(const Camera& camera, Vec3 v) {
    return v.x * camera.right + v.y * camera.up - v.z * camera.direction;
}

Vec3 to_key_light(const Camera& camera, Vec3 v, bool over_ground) {
    constexpr double least_height = 0.3;
    const Vec3 key = glm::normalize(from_camera(camera, v));
    return over_ground && key.y < least_height ? glm::normalize(Vec3(key.x, least_height, key.z)) : key;
}

void light_as_in_studio(View& view) {
    const Vec3 key = to_key_light(view.camera, key_direction, view.ground.has_value());
    view.lights = {{.location = key, .sun = true, .rgb = {1.12, 1.04, 0.92}, .angle_deg = key_angle_deg}};
    SkyLight sky;
    sky.zenith = {0.40, 0.48, 0.62};
    sky.horizon = {0.60, 0.61, 0.62};
    sky.below = {0.24, 0.225, 0.21};
    view.sky_light = sky;
}

Sky studio_backdrop(const View& view) {
    Sky backdrop{.zenith = {0.46, 0.475, 0.49}, .horizon = {0.72, 0.715, 0.70}};
    const Camera& camera = view.camera;
    if (camera.orthographic) {
        backdrop.zenith = backdrop.horizon = 0.5 * (backdrop.zenith + backdrop.horizon);
        return backdrop;
    }
    span_picture(backdrop, view);
    return backdrop;
}

std::optional<Haze> air_over_ground(const View& view, const Box& bounds) {
    const Camera& camera = view.camera;
    const Vec3 level(camera.direction.x, 0, camera.direction.z);
    const double distance = glm::length(bounds.centre() - camera.location);
    if (camera.orthographic || !(glm::length(level) > 0) || !(distance > 0)) return {};
    Haze haze;
    haze.rgb = view.background(glm::normalize(level));
    haze.distance = clear_distances * distance;
    haze.base = view.ground->height;
    haze.height = distance;
    return haze;
}

std::optional<ShadowCatcher> catcher_below(const View& view, const Box& bounds) {
    const Camera& camera = view.camera;
    const Vec3 size = bounds.size();
    ShadowCatcher catcher;
    catcher.centre = bounds.centre();
    catcher.centre.y = bounds.min.y;
    catcher.radius = catcher_reach * std::max({size.x, size.y, size.z});
    Vec3 sight = camera.direction;
    if (!camera.orthographic) {
        sight = catcher.centre - camera.location;
        if (!(glm::length(sight) > 0) || holds(bounds, camera.location)) return {};
        sight = glm::normalize(sight);
    }
    if (!(sight.y < -least_sight_slope)) return {};
    Rgb light = view.sky_light->on_paper();
    for (const Light& lamp : view.lights)
        light += std::max(lamp.location.y, 0.0) * lamp.rgb;
    const Rgb shown = view.background(sight);
    for (int i = 0; i < 3; ++i)
        catcher.rgb[i] = light[i] > 0 ? std::min(shown[i] / light[i], 1.0) : 0.0;
    return catcher;
}

} // namespace graftal
