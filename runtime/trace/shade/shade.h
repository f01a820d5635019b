#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "compiler/scene/light_list.h"
#include "compiler/scene/scene.h"
#include "runtime/image/texture.h"
#include "runtime/trace/shade/optics.h"
#include "runtime/trace/shade/sample_stream.h"
#include "runtime/trace/shade/surfaces.h"

namespace graftal {

/// Parts of a picture that POV-Ray leaves out.
struct ShaderLimits {
    /// Surfaces farther away along a ray. POV-Ray 3.7 meets nothing beyond 1e7 of its own units
    /// (PovrayUnits::scale to one of the model), which shows where the ground ends.
    double farthest = std::numeric_limits<double>::infinity();
    /// Reflected rays that would count for less: its adc_bailout.
    double least_weight = 1.0 / 255;
    /// Surfaces one behind the other: its max_trace_level.
    unsigned most_surfaces = Material::most_surfaces;
    /// Soft light comes from the lights of this list; nothing: from samples of it.
    std::optional<LightListSize> list;
};

/// Light, as POV-Ray 3.7 computes it for the scenes of compiler/povray: ambient, diffuse and specular light
/// of suns and point lights with their shadows, mirrors, the ground and the sky. Let c be the surface's
/// colour, and n its normal towards the viewer. Let v be the direction to the viewer, l that to a light of
/// colour e, and h halfway between v and l. The light along a ray is
///     ambient c + sum over the lights that are not shadowed, n.l > 0, of
///         (diffuse (n.l) c + specular (n.h)^(1/roughness)) e
///     + sum over those behind, n.l < 0, of translucency |n.l| c e + emission c
///     + reflection * (the light along the mirrored ray)
///     + transparency c * (the light along the refracted ray);
/// a transparent surface has so much less of the light that does not shine or mirror. With an index of
/// refraction the reflection goes by Fresnel's formula. That light is left out of all that does not shine; so
/// is the reflection of a surface that lets light through. Metals give highlights and reflections
/// their colour. A blurred surface mirrors and refracts by facets (formulas.glsl), one for each sample.
/// Within a solid, light fades as its interior says. Lights shine through on straight lines, coloured by each
/// surface and interior. Shadowless lights are not shadowed and have no specular part. Light from discs and
/// from the sky is the same sum over their parts, e = L dw / pi. It is estimated by one direction for each
/// (two where the sky is a picture with bright parts, by the balance heuristic: Veach 1997, 9.2.2). Or a list
/// of lights (light_list.h) gives it, to which the estimate converges as the list grows. Under a sky that
/// asks for bounces, surfaces light each other diffusely, and `ambient` is 0; the ray that looks for another
/// surface looks for the sky too. A picture shows up to 32 surfaces one in the other; the last of them shows
/// black. Nothing is clamped. (POV-Ray's trace.cpp: TraceRay, ComputeLightedTexture, ComputeOneDiffuseLight,
/// ComputeSpecularColour, ComputeReflection, ComputeRefraction, ComputeShadowColour, ComputeSky.)
class Shader {
  public:
    /// The first surfaces that some rays meet, the ground left out.
    struct Ahead {
        std::array<SurfaceHit, Surfaces::most_together> hits;
        std::uint32_t met = 0; ///< one bit for each ray
    };

    /// Keeps references to the view and the surfaces. `ground_texture`: of the ground's material; null: the
    /// ground shows its colour.
    Shader(const View& view, Surfaces& surfaces, const ShaderLimits& limits = {},
           std::shared_ptr<const Texture> ground_texture = nullptr);
    ~Shader();

    /// The light that comes along the ray, from the front; components may exceed 1, and are finite whatever
    /// is met. The direction is of unit length. Where soft light is sampled, an estimate by the numbers of
    /// the stream. `first`, if it is not null, gets what is met first; its material is null if that is the
    /// sky.
    Rgb radiance(const Ray& ray, SampleStream& random, SurfaceHit* first = nullptr) {
        return radiance(ray, random, first, nullptr);
    }
    /// The light along one of the rays that look_ahead() was asked for, by its number. It finds first
    /// surfaces faster for neighbours of a picture together.
    Rgb radiance(const Ray& ray, SampleStream& random, SurfaceHit* first, const Ahead& ahead,
                 std::size_t number);
    /// Requires at most Surfaces::most_together rays.
    void look_ahead(std::span<const Ray> rays, Ahead& ahead);
    /// The light along a ray where nothing is sampled.
    Rgb radiance(const Ray& ray) {
        SampleStream unused(0, 0);
        return radiance(ray, unused);
    }

    /// Steps that light has taken, besides those of rays (RayWork).
    std::uint64_t work() const { return work_; }

    /// True where radiance() estimates: more samples make a better picture.
    bool samples() const { return sky_ || !areas_.empty() || haze_sun_; }

    /// The first surface that the ray meets, the ground included; false if that is the sky.
    bool first_hit(const Ray& ray, SurfaceHit& hit);
    /// first_hit() of one of the rays that look_ahead() was asked for, by its number.
    bool first_hit(const Ray& ray, SurfaceHit& hit, const Ahead& ahead, std::size_t number);
    /// The light of the lamps, not of the sky, that comes along the ray from the first surface.
    Rgb light_of_lamps(const Ray& ray, const SurfaceHit& first, SampleStream& random);

  private:
    struct Lamp {
        Vec3 at; ///< of a sun: the unit vector towards it
        Rgb rgb;
        bool sun;
        bool shadowless;
    };
    /// A sun with an angle, or a lamp with an area.
    struct Area {
        Lamp middle;
        Vec3 a, b; ///< half axes: from the middle to its edge
        bool round;
    };
    struct Point;
    struct Path;
    struct Way;

    /// The known first surface of a ray; `hit` is null where there is none.
    struct Known {
        const SurfaceHit* hit;
    };
    static Known known(const Ahead& ahead, std::size_t number) {
        return {ahead.met >> number & 1 ? &ahead.hits[number] : nullptr};
    }
    Rgb radiance(const Ray& ray, SampleStream& random, SurfaceHit* first, const Known* known);
    bool closest(const Ray& ray, RayRange range, SurfaceHit& hit, const Known* known = nullptr);
    /// Where and how the ground is met; false beyond the range, along it, and where its picture is clear.
    bool meet_ground(const Ray& ray, const RayRange& range, double& t) const;
    static bool meet_level(double height, const Ray& ray, const RayRange& range, double& t);
    double meet_catcher(const Ray& ray, const RayRange& range, SurfaceHit& hit) const;
    const Texture::Texel& ground_texel(Vec3 point) const;
    /// Whether the surface mirrors and refracts by facets: of the list of lights, POV-Ray's are sharp.
    Point point_of(const Ray& ray, const Inside& inside, const SurfaceHit& hit, SampleStream& random) const;
    void share_light(Point& point) const;
    Rgb of_lamps(const Point& point, double least, SampleStream& random);
    Rgb lit(const Point& point, bool sky_later, SampleStream& random);
    Rgb from_sky(const Point& point, double least, bool shine_only, SampleStream& random);
    Rgb sky_light(double front_chance, const Point& point, double body, Vec3 direction, double least);
    Rgb shine(const Point& point, Vec3 to_light) const;
    static double scattered(const Point& point, double cosine);
    Rgb follow(Path& path, SampleStream& random, SurfaceHit* first = nullptr, const Known* known = nullptr);
    static double scattered_by(const Point& point);
    bool goes_on(Path& path, const Point& point, double scattered, bool sky_later, SampleStream& random);
    bool scatter(Path& path, const Point& point, double choice, SampleStream& random) const;
    Rgb light_of(const Lamp& lamp, const Point& point, double least);
    Rgb light_through(Ray to_light, RayRange range, const Inside& start);
    Rgb light_of_haze(const Path& path, double length, SampleStream& random);
    static Area disc_of(const Light& sun, const Lamp& middle);
    static Lamp part_of(const Area& area, SampleStream& random);
    Rgb sky(Vec3 direction) const;
    double least_distance(Vec3 point, double pixels) const;

    const View& view_;
    Surfaces& surfaces_;
    const ShaderLimits limits_;
    std::vector<Lamp> lamps_;                 ///< without those that are black
    std::vector<Area> areas_;                 ///< sampled ones
    std::optional<Area> haze_sun_;            ///< the sun that haze shows in shafts
    const SkyLight* sky_ = nullptr;           ///< null unless it is sampled
    const SkySampling* bright_sky_ = nullptr; ///< where it has bright parts
    std::vector<Path> waiting_;               ///< of the ray under way: what is to be followed still
    std::uint64_t work_ = 0, work_of_a_point_ = 0;
    bool all_opaque_;
    Inside camera_inside_; ///< of the ground
    Rgb ambient_light_;
    unsigned bounces_ = 0;
    double pixel_; ///< a pixel's length: of parallel rays in scene units, else at distance 1
    double sky_slope_;
    Material catcher_paper_;
    std::shared_ptr<const Texture> ground_texture_; ///< null: plain
    Affine picture_from_world_;                     ///< of the ground's
};

} // namespace graftal
