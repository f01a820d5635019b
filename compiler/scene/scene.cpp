#include "compiler/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>

#include "compiler/graph/pattern_colours.h"
#include "compiler/light/clouds.h"
#include "compiler/scene/backdrop.h"
#include "compiler/scene/framing.h"
#include "compiler/scene/studio.h"
#include "compiler/support/axes_across.h"
#include "compiler/support/check.h"

namespace graftal {

namespace {

/// A model without depth takes one light at right angles: a colour c is drawn as ambient * c + diffuse *
/// light * c = c. The light is shadowless: a highlight would lie over the whole of it.
std::vector<Light> flat_lights(const Camera& camera, int axis) {
    const Material ordinary;
    Vec3 towards(0.0);
    towards[axis] = camera.direction[axis] > 0 ? -1 : 1;
    return {{.location = towards,
             .sun = true,
             .rgb = Rgb((1 - ordinary.ambient) / ordinary.diffuse),
             .shadowless = true}};
}

/// Key and fill: on white of the default material they add up to less than 1 whichever way it faces.
std::vector<Light> solid_lights(const Camera& camera, bool over_ground) {
    const Vec3 key = to_key_light(camera, {-0.6, 0.75, 0.75}, over_ground);
    const Vec3 fill = glm::normalize(from_camera(camera, {0.85, 0.2, 0.6}));
    return {{.location = key, .sun = true, .rgb = {0.96, 0.93, 0.87}},
            {.location = fill, .sun = true, .rgb = {0.27, 0.29, 0.33}, .shadowless = true}};
}

/// Axes of a lamp that looks along the way: one level, and one upwards; x is level for a lamp that looks up
/// or down.
AxesAcross lamp_axes(Vec3 way) {
    const Vec3 direction = glm::normalize(way);
    const Vec3 level = glm::cross(direction, Vec3(0, 1, 0));
    constexpr double steep = 1e-6;
    const Vec3 a = glm::length(level) > steep ? glm::normalize(level) : Vec3(1, 0, 0);
    return {a, glm::cross(a, direction)};
}

std::vector<Light> model_lights(const std::vector<LightSetting>& settings) {
    std::vector<Light> lights;
    for (const LightSetting& setting : settings) {
        Light light{setting.location, setting.sun, setting.rgb, setting.shadowless, setting.angle_deg};
        if (setting.sun) {
            const double largest = largest_entry(setting.location);
            // A sun from nowhere stands overhead.
            light.location = largest > 0 ? glm::normalize(setting.location / largest) : Vec3(0, 1, 0);
        }
        if (setting.look_at) {
            const bool round = light.round = setting.radius > 0;
            const auto [a, b] = lamp_axes(*setting.look_at - setting.location);
            light.a = (round ? setting.radius : 0.5 * setting.width) * a;
            light.b = (round ? setting.radius : 0.5 * setting.height) * b;
        }
        lights.push_back(light);
    }
    return lights;
}

SkyLight resolve(const SkySetting& setting, const std::vector<Light>& lights, CloudPictures* pictures) {
    SkyLight sky;
    sky.picture = setting.picture;
    sky.picture_from_world = Affine::rotate({0, 1, 0}, -setting.turn_deg).linear;
    sky.zenith = setting.brightness * setting.zenith;
    sky.horizon = setting.brightness * setting.horizon;
    sky.below = setting.brightness * setting.below;
    sky.brightness = setting.brightness;
    sky.bounces = setting.bounces;
    const auto sun = std::ranges::find_if(lights, [](const Light& light) { return light.sun; });
    if (setting.turbidity && sun != lights.end())
        sky.clear.emplace(*setting.turbidity, sun->location, sky.up);
    if (setting.clouds) {
        Clouds clouds{.cover = *setting.clouds, .turn_deg = setting.turn_deg};
        if (sun != lights.end()) {
            clouds.to_sun = sun->location;
            clouds.sun_rgb = sun->rgb;
        }
        sky.picture = pictures ? pictures->picture(sky, clouds) : cloudy_picture(sky, clouds);
        sky.picture_from_world = Mat3(1.0);
        sky.brightness = 1;
    }
    return sky;
}

Ground resolve(const GroundSetting& setting, const std::vector<Material>& materials) {
    Ground ground;
    ground.height = setting.height;
    ground.material.rgb = {0.42, 0.41, 0.38};
    ground.material.specular = 0;
    if (setting.material)
        for (const Material& material : materials)
            if (material.name == *setting.material) ground.material = material;
    if (setting.rgb) {
        ground.material.rgb = *setting.rgb;
        ground.material.texture.clear();
        ground.material.coverage = 1;
        if (ground.material.pattern) take_own_colours(ground.material);
    }
    return ground;
}

Haze resolve(const HazeSetting& setting, const View& view) {
    Haze haze;
    haze.distance = setting.distance;
    haze.base = setting.base;
    haze.height = setting.height.value_or(std::numeric_limits<double>::infinity());
    const Vec3 level(view.camera.direction.x, 0, view.camera.direction.z);
    const double length = glm::length(level);
    Vec3 horizon = length > 0 ? level / length : Vec3(1, 0, 0);
    // A picture's light at the horizon is half of what lies below.
    if (view.sky_light && view.sky_light->picture)
        horizon = glm::normalize(horizon + Vec3(0, 2.0 / view.sky_light->picture->height(), 0));
    haze.rgb = setting.rgb.value_or(view.background(horizon));
    haze.sun = setting.sun;
    return haze;
}

/// Behind the eye nothing can be sharp.
Lens resolve_lens(const CameraSetting& setting, const Camera& camera, const Box& bounds) {
    const double radius = setting.aperture.value_or(0);
    if (!(radius > 0) || camera.orthographic) return {};
    const Vec3 focus = setting.focus ? *setting.focus : setting.look_at.value_or(bounds.centre());
    const double depth = glm::dot(focus - camera.location, camera.direction);
    return depth > 0 ? Lens{radius, depth} : Lens{};
}

/// Pictures under a sky are soft; those under a clear one, whose colours are measured, are for daylight.
Film resolve_film(const SceneSettings& settings, bool under_sky) {
    if (settings.film) return *settings.film;
    constexpr double daylight_k = 5600;
    Film film;
    film.soft = under_sky;
    if (settings.sky && settings.sky->turbidity) film.white_k = daylight_k;
    return film;
}

} // namespace

double Camera::pixels_per_unit(Vec3 point, int width_px) const {
    if (orthographic) return width_px / width;
    const Vec3 sight = point - location;
    const double depth = glm::dot(sight, direction);
    if (!(depth > 0)) return std::numeric_limits<double>::infinity();
    const double focal_px = 0.5 * width_px / std::tan(angle_deg * std::numbers::pi / 360);
    return focal_px / depth * (glm::length(sight) / depth);
}

Rgb Sky::colour(Vec3 direction) const {
    const double t = std::clamp((glm::dot(direction, axis) - from) / (to - from), 0.0, 1.0);
    return (1 - t) * horizon + t * zenith;
}

Rgb View::background(Vec3 direction) const {
    return shows_sky_light ? sky_light->radiance(direction) : sky.colour(direction);
}

Rgb View::ambient_light() const {
    return sky_light ? sky_light->on_paper() : Rgb(1.0);
}

bool View::has_soft_light() const {
    return sky_light ||
           std::ranges::any_of(lights, [](const Light& light) { return light.is_disc() || light.is_area(); });
}

const Light* View::sun_of_haze() const {
    if (!haze || !(haze->sun > 0)) return nullptr;
    const auto sun = std::ranges::find_if(lights, &Light::sun);
    return sun == lights.end() ? nullptr : &*sun;
}

bool shows_blur(const Graph& graph, const View& view) {
    const auto blurred = [&](const std::optional<MaterialId>& id) {
        return id && graph.materials[*id].is_blurred();
    };
    return (view.ground && view.ground->material.is_blurred()) ||
           std::ranges::any_of(graph.objects, [&](const Object& object) {
               return std::ranges::any_of(object.packed.materials, blurred) ||
                      std::ranges::any_of(object.instances,
                                          [&](const Instance& part) { return blurred(part.material); });
           });
}

View frame(const Graph& graph, const Box& bounds, ImageSize size, const CameraOverride& camera,
           const Outliner& outliner, DefaultLight light, CloudPictures* clouds) {
    GRAFTAL_CHECK(!bounds.empty(), "frame: empty bounds");
    GRAFTAL_CHECK(size.width > 0 && size.height > 0, "frame: empty picture");
    const CameraSetting setting = merge(graph.settings.camera.value_or(CameraSetting{}), camera);
    return view_through(frame_camera(setting, bounds, outliner, size), setting, graph, bounds, size,
                        sample_colours(graph), light, clouds);
}

View view_through(const Camera& camera, const CameraSetting& setting, const Graph& graph, const Box& bounds,
                  ImageSize size, const std::vector<Rgb>& colours, DefaultLight light,
                  CloudPictures* clouds) {
    const SceneSettings& settings = graph.settings;
    const bool flat = thickness(bounds) <= flat_share;
    View view;
    view.size = size;
    view.camera = camera;
    if (settings.ground) view.ground = resolve(*settings.ground, graph.materials);
    const bool silent = settings.lights.empty() && !settings.sky; // about light
    const bool studio = silent && light == DefaultLight::studio && !is_figure(bounds);
    if (!silent)
        view.lights = model_lights(settings.lights);
    else if (studio)
        light_as_in_studio(view);
    else if (flat)
        view.lights = flat_lights(view.camera, thinnest_axis(bounds));
    else
        view.lights = solid_lights(view.camera, view.ground.has_value());
    if (settings.sky) {
        view.sky_light = resolve(*settings.sky, view.lights, clouds);
        view.shows_sky_light = !settings.background;
    }
    view.film = resolve_film(settings, view.sky_light.has_value());
    view.lens = resolve_lens(setting, camera, bounds);
    if (settings.background) {
        view.sky.zenith = settings.background->rgb;
        view.sky.horizon = settings.background->horizon.value_or(settings.background->rgb);
    } else if (studio && !view.ground) {
        view.sky = studio_backdrop(view);
    } else {
        view.sky = automatic_sky(colours, view, is_figure(bounds));
    }
    if (studio && !view.ground) view.catcher = catcher_below(view, bounds);
    if (settings.haze)
        view.haze = resolve(*settings.haze, view);
    else if (studio && view.ground)
        view.haze = air_over_ground(view, bounds);
    return view;
}

void clear_background(View& view) {
    view.sky.zenith = view.sky.horizon = Rgb(0.0);
    view.shows_sky_light = false;
    view.haze.reset();
    view.catcher.reset();
}

} // namespace graftal
