#include "compiler/scene/light_list.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "compiler/support/axes_across.h"

namespace graftal {

namespace {

/// Between neighbours of a spiral whose points spread evenly.
const double golden_turn = std::numbers::pi * (3 - std::sqrt(5.0));

Vec3 around(Vec3 direction, const AxesAcross& axes, double along, double radius, double turn) {
    return glm::normalize(along * direction + radius * (std::cos(turn) * axes.a + std::sin(turn) * axes.b));
}

void list_disc(const Light& sun, unsigned count, std::vector<Light>& list) {
    const double radius = std::tan(0.5 * sun.angle_deg * std::numbers::pi / 180);
    const AxesAcross axes = axes_across(sun.location);
    for (unsigned i = 0; i < count; ++i) {
        Light part = sun;
        part.angle_deg = 0;
        part.rgb = sun.rgb / static_cast<double>(count);
        part.location = around(sun.location, axes, 1, radius * std::sqrt((i + 0.5) / count), i * golden_turn);
        list.push_back(part);
    }
}

void list_area(const Light& lamp, unsigned count, std::vector<Light>& list) {
    const double golden_share = 0.5 * golden_turn / std::numbers::pi;
    for (unsigned i = 0; i < count; ++i) {
        Light part = lamp;
        part.a = part.b = Vec3(0.0);
        part.rgb = lamp.rgb / static_cast<double>(count);
        const double share = (i + 0.5) / count, turn = i * golden_turn;
        const Vec3 place =
            lamp.round ? std::sqrt(share) * (std::cos(turn) * lamp.a + std::sin(turn) * lamp.b)
                       : (2 * share - 1) * lamp.a + (2 * std::fmod(0.5 + i * golden_share, 1.0) - 1) * lamp.b;
        part.location = lamp.location + place;
        list.push_back(part);
    }
}

/// Directions whose cosine with `up` lies between `low` and `high`.
void list_zone(const SkyLight& sky, double low, double high, unsigned count, std::vector<Light>& list) {
    const AxesAcross axes = axes_across(sky.up);
    for (unsigned i = 0; i < count; ++i) {
        const double along = high - (high - low) * (i + 0.5) / count;
        const Vec3 towards = around(sky.up, axes, along, std::sqrt(1 - along * along), i * golden_turn);
        const double share = 2 * (high - low) / count; // of 2 pi (high - low) in all, over pi
        const Rgb rgb = share * sky.radiance(towards);
        if (std::max({rgb.r, rgb.g, rgb.b}) > 0)
            list.push_back({.location = towards, .sun = true, .rgb = rgb});
    }
}

void list_picture(const SkyLight& sky, unsigned count, bool above_only, std::vector<Light>& list) {
    const Mat3 world_from_picture = glm::transpose(sky.picture_from_world);
    for (const SkyRegion& region : sky_regions(sky.picture->cells(), count, above_only))
        if (const Rgb rgb = sky.brightness / std::numbers::pi * region.power;
            std::max({rgb.r, rgb.g, rgb.b}) > 0)
            list.push_back(
                {.location = glm::normalize(world_from_picture * region.direction), .sun = true, .rgb = rgb});
}

} // namespace

LightListSize list_size(Quality quality) {
    // POV-Ray's time grows as their number does. 16 show bands, 32 are enough, 64 look like 512.
    return by_quality<LightListSize>(quality, {4, 16, 9}, {8, 40, 32}, {16, 160, 128});
}

std::vector<Light> listed_lights(const View& view, const LightListSize& size) {
    std::vector<Light> list;
    for (const Light& light : view.lights)
        if (light.is_disc())
            list_disc(light, size.disc, list);
        else if (light.is_area())
            list_area(light, size.area, list);
        else
            list.push_back(light);
    if (!view.sky_light) return list;
    if (view.sky_light->picture) {
        list_picture(*view.sky_light, size.dome, view.ground.has_value(), list);
        return list;
    }
    // Light from below counts less than the sky, and not at all through a ground.
    const unsigned from_below = view.ground ? 0 : size.dome / 5;
    list_zone(*view.sky_light, 0, 1, size.dome - from_below, list);
    if (from_below > 0) list_zone(*view.sky_light, -1, 0, from_below, list);
    return list;
}

} // namespace graftal
