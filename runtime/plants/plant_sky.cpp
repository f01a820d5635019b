#include "runtime/plants/plant_sky.h"

#include <algorithm>

#include <glm/geometric.hpp>

namespace graftal {

namespace {

double on_level(const PlantSky::Sun& sun) {
    return sun.to.y * (sun.rgb.r + sun.rgb.g + sun.rgb.b);
}

} // namespace

Rgb PlantSky::radiance(Vec3 direction) const {
    return sky && direction.y > 0 ? sky->radiance(direction) : Rgb(0.0);
}

Rgb PlantSky::open() const {
    Rgb sum = sky ? sky->on_paper() : Rgb(0.0);
    for (const Sun& sun : suns)
        sum += sun.to.y * sun.rgb;
    return sum;
}

PlantSky PlantSky::uniform() {
    PlantSky light;
    SkyLight& sky = light.sky.emplace();
    sky.zenith = sky.horizon = Rgb(1.0);
    return light;
}

PlantSky sky_of_plant(const View& view, const SceneSettings& settings) {
    if (settings.lights.empty() && !settings.sky) return PlantSky::uniform();
    PlantSky light;
    if (settings.sky) light.sky = view.sky_light;
    for (const Light& lamp : view.lights)
        if (lamp.sun && !lamp.shadowless && lamp.location.y > 0)
            light.suns.push_back({lamp.location, lamp.rgb, lamp.angle_deg});
    std::ranges::stable_sort(light.suns, std::ranges::greater(), on_level);
    return light;
}

} // namespace graftal
