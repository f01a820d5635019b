#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compiler/graph/material.h"
#include "compiler/light/film.h"
#include "compiler/light/sky_picture.h"
#include "compiler/support/affine.h"
#include "compiler/support/flat_area.h"
#include "compiler/support/tint.h"

namespace graftal {

/// The model's settings of the camera; others are framed automatically (scene/framing.h).
struct CameraSetting {
    std::optional<Vec3> location;
    std::optional<Vec3> look_at;
    std::optional<Vec3> up;
    std::optional<Vec3> direction;   ///< in which a camera without a location looks
    std::optional<double> angle_deg; ///< horizontal angle of view, in (0, 180)
    bool orthographic = false;
    std::optional<double> width;    ///< orthographic: width of the view in scene units
    std::optional<double> height;   ///< with a width: the view shows this height too, and is wider if it must
    std::optional<double> aperture; ///< radius of the lens; 0 or nothing: all is sharp
    std::optional<Vec3> focus;      ///< a sharp point, as all at its depth; nothing: look_at
    bool operator==(const CameraSetting&) const = default;
};

struct LightSetting {
    Vec3 location{0.0}; ///< of a point light; for a sun the direction it comes from
    bool sun = false;   ///< parallel rays
    Rgb rgb{1.0};
    bool shadowless = false;
    double angle_deg = 0;         ///< apparent diameter of a sun
    double width = 0, height = 0; ///< of a lamp that is a rectangle
    double radius = 0;            ///< of a lamp that is a disc
    std::optional<Vec3> look_at;  ///< point that a disc faces
    bool operator==(const LightSetting&) const = default;
};

/// Light from everywhere (light/sky_light.h).
struct SkySetting {
    Rgb zenith{0.35, 0.52, 0.85}, horizon{0.85, 0.9, 0.95};
    Rgb below{0.2, 0.19, 0.17};
    std::optional<double> turbidity;           ///< a clear sky, about the first sun among the lights
    std::string environment;                   ///< the file of a picture (SkyPicture); empty: none
    std::shared_ptr<const SkyPicture> picture; ///< its picture; null: nobody has read it, and it is white
    std::optional<double> clouds;              ///< the share of the sky that they cover (light/clouds.h)
    double turn_deg = 0;   ///< of picture or clouds about y; 90 brings its middle from x to -z
    double brightness = 1; ///< of all of it
    unsigned bounces = 0;
    bool operator==(const SkySetting&) const = default;
};

/// Air (light/haze.h).
struct HazeSetting {
    double distance = 0;
    double base = 0;
    std::optional<double> height; ///< nothing: even all over, as far as anything is seen
    std::optional<Rgb> rgb;       ///< nothing: as the sky at the horizon
    double sun = 0;               ///< the share of its light that is the first sun's
    bool operator==(const HazeSetting&) const = default;
};

struct GroundSetting {
    double height = 0;                   ///< the plane y = height
    std::optional<std::string> material; ///< by name; else a neutral one
    std::optional<Rgb> rgb;
    std::optional<FlatArea> area; ///< area of `scatter` with `over: ground`; the plane goes on
    bool operator==(const GroundSetting&) const = default;
};

struct BackgroundSetting {
    Rgb rgb{1.0};
    std::optional<Rgb> horizon; ///< then the sky runs from this, at the horizon, to rgb, overhead
    bool operator==(const BackgroundSetting&) const = default;
};

/// The scene statements of a model, shared by all languages.
struct SceneSettings {
    std::optional<CameraSetting> camera;
    std::vector<LightSetting> lights;
    std::optional<BackgroundSetting> background;
    std::optional<GroundSetting> ground;
    std::optional<SkySetting> sky;
    std::optional<Film> film;
    std::optional<HazeSetting> haze;
    std::optional<unsigned> steps; ///< the depth that the model asks for where the command line is silent
    bool operator==(const SceneSettings&) const = default;
};

} // namespace graftal
