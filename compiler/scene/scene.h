#pragma once

// The scene besides geometry: a camera, lights and a sky, all in world space (right-handed, y up). Decided
// here from the model's scene statements and its bounds; engines only follow.

#include <functional>
#include <optional>
#include <vector>

#include "compiler/analysis/bounding.h"
#include "compiler/graph/graph.h"
#include "compiler/light/film.h"
#include "compiler/light/haze.h"
#include "compiler/light/sky_light.h"
#include "compiler/scene/shadow_catcher.h"
#include "compiler/support/bounds.h"

namespace graftal {

class CloudPictures;

struct ImageSize {
    int width = 1280;
    int height = 720;
    bool operator==(const ImageSize&) const = default;
};

/// A resolved camera. right, up and direction are orthonormal and right-handed: right x up = -direction.
struct Camera {
    Vec3 location{0, 0, 1};
    Vec3 direction{0, 0, -1};
    Vec3 up{0, 1, 0};
    Vec3 right{1, 0, 0};
    bool orthographic = false;
    double angle_deg = 40; ///< horizontal angle of view; perspective only
    double width = 1;      ///< of the view in scene units; orthographic only

    /// Pixels per scene unit at the point, for a picture `width_px` wide, at most: for a length at right
    /// angles to the line of sight. (Towards the corners of a perspective picture it is drawn out radially.)
    /// Infinity at or behind the eye of a perspective camera.
    double pixels_per_unit(Vec3 point, int width_px) const;
};

/// A camera's lens: everything at one depth is sharp.
struct Lens {
    double radius = 0; ///< 0: all is sharp
    double depth = 1;  ///< along the camera's direction
};

struct Light {
    Vec3 location{0.0}; ///< of a sun: a unit vector towards it
    bool sun = false;
    Rgb rgb{1.0};
    bool shadowless = false; ///< then it makes no highlights either, as in POV-Ray
    double angle_deg = 0;    ///< apparent diameter of a sun
    Vec3 a{0.0}, b{0.0};     ///< of a lamp: half of its rectangle's sides, or of its disc's axes; 0: a point
    bool round = false;      ///< a disc

    /// Whether its light comes from a disc in the sky.
    bool is_disc() const { return sun && angle_deg > 0 && !shadowless; }
    /// Whether it comes from all points of an area alike, each as bright in all directions and at all
    /// distances.
    bool is_area() const { return !sun && !shadowless && a != Vec3(0.0); }
};

/// Work that goes into pictures that converge.
enum class Quality { draft, normal, best };

template<typename Value> constexpr Value by_quality(Quality quality, Value draft, Value normal, Value best) {
    return quality == Quality::draft ? draft : quality == Quality::normal ? normal : best;
}

/// The background in a direction d (unit) is `horizon` where dot(d, axis) <= from, and `zenith` where dot(d,
/// axis) >= to. Between them it is linear in that product.
struct Sky {
    Rgb zenith{1.0};
    Rgb horizon{1.0}; ///< equal to zenith: a plain background
    Vec3 axis{0, 1, 0};
    double from = 0;
    double to = 1;

    Rgb colour(Vec3 direction) const;
};

struct Ground {
    double height = 0;
    Material material;
};

struct View {
    ImageSize size;
    Camera camera;
    Lens lens;
    std::vector<Light> lights;
    Sky sky;
    std::optional<Ground> ground;
    std::optional<ShadowCatcher> catcher;
    std::optional<SkyLight> sky_light; ///< light from all directions; nothing: what lights there are
    bool shows_sky_light = false;      ///< in place of `sky`, as the background
    std::optional<Haze> haze;
    Film film;
    Quality quality = Quality::normal;

    /// Light from the direction of a ray (unit) that meets nothing.
    Rgb background(Vec3 direction) const;
    /// Light of which `ambient` is a share: the sky's light on paper, or 1 without a sky of light.
    Rgb ambient_light() const;
    /// Whether light comes from more than points: from discs, or from all directions.
    bool has_soft_light() const;
    /// The first sun, if haze shows its light in shafts; else null.
    const Light* sun_of_haze() const;
};

/// Whether the model or its ground has a material whose mirrors or glass are blurred.
bool shows_blur(const Graph& graph, const View& view);

/// Gives points whose convex hull holds the model, close to it where it reaches farthest in the directions.
using Outliner = std::function<std::vector<Vec3>(const std::vector<Vec3>& directions)>;

/// `--camera` of the command line: like the model's camera statement, and taking precedence over it field by
/// field.
using CameraOverride = CameraSetting;

/// The light of a solid model that names none.
enum class DefaultLight {
    studio, ///< studio.h
    plain,  ///< one sun with sharp shadows over the viewer's left shoulder, a shadowless fill from the right
};

/// Resolves the scene statements of the model. What they leave out is chosen so that the whole of `bounds`
/// is in the picture with a small margin: flat models (no depth along one axis) face on, undistorted and in
/// their true colours; models in space from the front, a little from the right and above, in the light of a
/// studio (studio.h) where they name no light; figures on a background that lets them stand out. With an
/// outline as well, the picture is filled by the model itself rather than by its box. Requires bounds that
/// are not empty. `clouds` may keep the picture of a cloudy sky for the next view; null: none is kept.
View frame(const Graph& graph, const Box& bounds, ImageSize size, const CameraOverride& camera = {},
           const Outliner& outliner = {}, DefaultLight light = DefaultLight::studio,
           CloudPictures* clouds = nullptr);

/// The view through a camera that is settled, with the lens of `setting`; the rest is chosen as frame() does
/// it, for a model of these bounds that shows these colours (backdrop.h).
View view_through(const Camera& camera, const CameraSetting& setting, const Graph& graph, const Box& bounds,
                  ImageSize size, const std::vector<Rgb>& colours, DefaultLight light = DefaultLight::studio,
                  CloudPictures* clouds = nullptr);

/// Leaves nothing behind the model but black: no sky that is seen, no haze, and no paper of a studio. Light
/// and ground stay.
void clear_background(View& view);

} // namespace graftal
