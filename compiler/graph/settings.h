#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/support/affine.h"
#include "compiler/support/flat_area.h"
#include "compiler/support/source.h"
#include "compiler/support/tint.h"

namespace graftal {

/// How a surface takes light; the numbers are POV-Ray's finish, which the tracer follows too.
struct Material {
    std::string name;
    Rgb rgb{0.8};
    double ambient = 0.1;
    double diffuse = 0.8;
    double specular = 0.1;
    double roughness = 0.05;
    double reflection = 0;
    /// The picture that is wrapped round each primitive in place of rgb (texture_space.h), by the file it is
    /// read from or the model it is drawn from; empty: none. Where its alpha is below 1/2 there is no
    /// surface.
    std::string texture;
    double around = 1;   ///< how often it goes round what is round
    double coverage = 1; ///< share of the picture that is not clear
    Span span;

    /// Spans do not count.
    bool operator==(const Material& other) const;
};

/// What the model says about the camera; what it leaves out is framed automatically (scene/framing.h).
struct CameraSetting {
    std::optional<Vec3> location;
    std::optional<Vec3> look_at;
    std::optional<Vec3> up;
    std::optional<double> angle_deg; ///< horizontal angle of view, in (0, 180)
    bool orthographic = false;
    std::optional<double> width; ///< orthographic: width of the view in scene units
    bool operator==(const CameraSetting&) const = default;
};

struct LightSetting {
    Vec3 location{0.0}; ///< of a point light; for a sun the direction it comes from
    bool sun = false;   ///< parallel rays
    Rgb rgb{1.0};
    bool shadowless = false;
    bool operator==(const LightSetting&) const = default;
};

struct GroundSetting {
    double height = 0;                   ///< the plane y = height
    std::optional<std::string> material; ///< by name; else a neutral one
    std::optional<Rgb> rgb;
    std::optional<FlatArea> area; ///< what `scatter` covers with `over: ground`; the plane goes on
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
    std::optional<unsigned> steps; ///< the depth that the model asks for where the command line is silent
    bool operator==(const SceneSettings&) const = default;
};

} // namespace graftal
