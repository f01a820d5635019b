#pragma once

#include <cstdint>

#include "runtime/plants/organ_surface.h"
#include "runtime/plants/plant_sky.h"
#include "runtime/trace/model/trace_model.h"
#include "runtime/trace/shade/sample_stream.h"
#include "runtime/trace/traverse/traversal.h"

namespace graftal {

/// One look at the light on an organ, from a point of its surface. Numbers are means over the colours, where
/// the open horizontal plane has 1; of flat organs they are sums over both sides.
struct OrganSample {
    double direct = 0;   ///< light that has met nothing before
    double light = 0;    ///< and light that other organs scatter
    double absorbed = 0; ///< the share of that which the organ takes
    bool sunlit = false; ///< by the brightest sun
    // The way of the direct light after it, by chance: its sum is `direct`.
    double taken = 0; ///< by all organs that it meets
    double to_sky = 0, to_ground = 0;
    double left = 0; ///< of a way so long that it was given up
};

/// The rays of one thread through a plant. Organs scatter light diffusely, by their materials: the share
/// diffuse * colour on the side that it falls on, translucency * colour on the other. Highlights, mirrors and
/// glass are left out: what is transparent takes light as if it were not. The ground takes all that it gets.
class PlantRays {
  public:
    /// Keeps references.
    PlantRays(const TraceModel& model, const PlantSky& sky);

    /// A function of the organ and both numbers. `index`: of the samples of one seed, which spread evenly.
    OrganSample sample(const OrganSurface& organ, std::uint64_t seed, std::uint32_t index);

    std::uint64_t rays() const { return rays_; }
    std::uint64_t work() const { return traversal_.work(); } ///< RayWork
    std::uint64_t given_up() const { return traversal_.given_up(); }

  private:
    struct Finish {
        Rgb reflected{0.0}, passed{0.0};
    };

    /// Where light meets a surface. The normal is on the side that it comes from.
    struct Met {
        Vec3 point{0.0}, normal{0, 1, 0};
        Vec3 to_far_side{0.0}; ///< SurfaceHit's
    };

    static Finish finish_of(const SurfaceHit& hit);
    static Met met_by(const Ray& ray, const SurfaceHit& hit);
    static bool scatter(Rgb& weight, const Finish& finish, double choice);
    bool closest(const Ray& ray, const RayRange& range, SurfaceHit& hit);
    bool is_lit(Vec3 point, Vec3 direction);
    Vec3 towards(const PlantSky::Sun& sun, SampleStream& random) const;
    double mean(Rgb light) const { return (light.r + light.g + light.b) / (3 * open_); }
    Vec3 start_on(const Met& met, bool other_side) const;
    Ray scattered_from(const Met& met, bool passes, SampleStream& random) const;
    Rgb of_suns(const Met& met, Rgb front, Rgb back, SampleStream& random);
    Rgb scattered(Ray ray, SurfaceHit hit, SampleStream& random);
    void follow(Ray ray, Rgb weight, SampleStream& random, OrganSample& sample);

    const PlantSky& sky_;
    Traversal traversal_;
    double open_ = 1; ///< mean over the colours
    double gap_ = 0;  ///< by which rays start off surfaces
    std::uint64_t rays_ = 0;
};

} // namespace graftal
