// What some rays meet first and what shines on that, found together: neighbours of a picture look into the
// same parts, and so do their shadow rays to one lamp. All numbers are those that each ray gets by itself.

#include <array>
#include <span>

#include "runtime/trace/shade_point.h"

namespace graftal {

void Shader::look_ahead(std::span<const Ray> rays, std::span<const SampleStream> randoms) {
    std::array<SurfaceHit, Surfaces::most_together> hits;
    const std::uint32_t met = surfaces_.closest_each(rays, {0, limits_.farthest}, hits);
    ahead_.resize(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
        Ahead& ahead = ahead_[i];
        ahead.ray = rays[i];
        ahead.random = randoms[i];
        ahead.hit = hits[i];
        ahead.found = (met >> i & 1) != 0;
        prepare(ahead);
    }
    shade_together();
}

/// As follow() begins.
void Shader::prepare(Ahead& ahead) const {
    ahead.shines.clear();
    Path path;
    path.ray = ahead.ray;
    path.inside = camera_inside_;
    SurfaceHit hit = ahead.hit;
    const bool found = closest_with_ground(path.ray, path.range, ahead.found, hit);
    const bool is_caught = meet_catcher(path.ray, path.range, found, hit) > 0;
    if (!found && !is_caught) return;
    ahead.random_after = ahead.random;
    ahead.point = point_of(path, hit, ahead.random_after);
    const double scattered = bounces_ > 0 ? scattered_by(ahead.point) : 0;
    find_shines(ahead.point, !is_caught && leaves_sky(path.counts, scattered), ahead.random_after,
                ahead.shines);
}

/// Finds what is in the way of lamps, lamp by lamp. What comes from the sky comes from everywhere, so that
/// its rays have nothing in common.
void Shader::shade_together() {
    const std::size_t lamps = lamps_.size() + areas_.size();
    for (std::size_t lamp = 0; lamp < lamps; ++lamp) {
        std::array<Ray, Surfaces::most_together> rays;
        std::array<RayRange, Surfaces::most_together> ranges;
        std::array<Shine*, Surfaces::most_together> asked;
        std::size_t count = 0;
        for (Ahead& ahead : ahead_)
            for (Shine& shine : ahead.shines) {
                if (shine.lamp != lamp || shine.is_through) continue;
                double t = 0;
                shine.is_shaded = view_.ground && meet_ground(shine.to_light, shine.range, t);
                if (shine.is_shaded) continue;
                rays[count] = shine.to_light;
                ranges[count] = shine.range;
                asked[count++] = &shine;
            }
        if (count == 0) continue;
        const std::uint32_t shaded =
            surfaces_.meets_any_each(std::span(rays).first(count), std::span(ranges).first(count));
        for (std::size_t i = 0; i < count; ++i)
            asked[i]->is_shaded = (shaded >> i & 1) != 0;
    }
    for (Ahead& ahead : ahead_)
        for (Shine& shine : ahead.shines)
            if (shine.is_of_sky()) shine.is_shaded = is_shaded(shine);
}

Rgb Shader::radiance_ahead(std::size_t number, SurfaceHit* first) {
    const Ahead& ahead = ahead_[number];
    SampleStream random = ahead.random;
    return radiance(ahead.ray, random, first, &ahead);
}

} // namespace graftal
