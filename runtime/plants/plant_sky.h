#pragma once

#include <optional>
#include <vector>

#include "compiler/scene/scene.h"

namespace graftal {

/// The light that falls on a plant: of a sky, and of suns. Radiance is that of white paper under a light of 1
/// (sky_light.h), and so is irradiance: over pi.
struct PlantSky {
    struct Sun {
        Vec3 to{0, 1, 0}; ///< unit vector
        Rgb rgb{1.0};     ///< irradiance of a plane that faces it
        double angle_deg = 0;
    };

    std::optional<SkyLight> sky; ///< above the horizon; nothing comes from below
    std::vector<Sun> suns;       ///< above the horizon, the brightest on an open horizontal plane first

    Rgb radiance(Vec3 direction) const;
    /// Irradiance of an open horizontal plane.
    Rgb open() const;
    /// The white sky that is as bright in all directions.
    static PlantSky uniform();
};

/// The light that a model's text names, in its view: its sky and its suns, without lamps. Suns that are
/// `shadowless` only fill shadows in pictures, and are left out. Where the text names no light, a uniform
/// sky.
PlantSky sky_of_plant(const View& view, const SceneSettings& settings);

} // namespace graftal
