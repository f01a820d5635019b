#include "runtime/plants/plant_rays.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "compiler/support/counter_random.h"
#include "runtime/trace/shade/formulas.h"

namespace graftal {

namespace {

constexpr int most_scatterings = 64;
/// The share of light that is not followed any more.
constexpr double little_left = 1e-4;

double sum(Rgb rgb) {
    return rgb.r + rgb.g + rgb.b;
}

} // namespace

PlantRays::PlantRays(const TraceModel& model, const PlantSky& sky) : sky_(sky), traversal_(model) {
    constexpr double share = 1e-6; // of the plant
    const Box& box = model.prepared.bounds;
    if (!box.empty()) gap_ = share * glm::length(box.size());
    open_ = sum(sky.open()) / 3;
}

/// Colours above 1 would make light.
PlantRays::Finish PlantRays::finish_of(const SurfaceHit& hit) {
    Finish finish{hit.material->diffuse * hit.rgb, hit.material->translucency * hit.rgb};
    const Rgb both = finish.reflected + finish.passed;
    if (const double most = std::max({both.r, both.g, both.b}); most > 1) {
        finish.reflected /= most;
        finish.passed /= most;
    }
    return finish;
}

/// Leaves of the light what goes on to one side, with as much of it as goes on in all; true if that is the
/// other side. `choice`: in [0, 1).
bool PlantRays::scatter(Rgb& weight, const Finish& finish, double choice) {
    const Rgb back = weight * finish.reflected, through = weight * finish.passed;
    const double reflected = sum(back), passed = sum(through), all = reflected + passed;
    if (!(all > 0)) {
        weight = Rgb(0.0);
        return false;
    }
    const bool passes = choice * all < passed;
    weight = passes ? all / passed * through : all / reflected * back;
    return passes;
}

bool PlantRays::closest(const Ray& ray, const RayRange& range, SurfaceHit& hit) {
    ++rays_;
    return traversal_.closest(ray, range, hit);
}

bool PlantRays::is_lit(Vec3 point, Vec3 direction) {
    ++rays_;
    return !traversal_.meets_any({point, direction}, {});
}

/// A point of the sun's disc.
Vec3 PlantRays::towards(const PlantSky::Sun& sun, SampleStream& random) const {
    if (!(sun.angle_deg > 0)) return sun.to;
    const glm::dvec2 place = random.next();
    const double radius = std::tan(glm::radians(sun.angle_deg) / 2) * std::sqrt(place.x);
    const double turn = 2 * std::numbers::pi * place.y;
    Vec3 a, b;
    formulas::axes_across_of(sun.to, a, b);
    return glm::normalize(sun.to + radius * (std::cos(turn) * a + std::sin(turn) * b));
}

PlantRays::Met PlantRays::met_by(const Ray& ray, const SurfaceHit& hit) {
    return {ray(hit.t), glm::dot(hit.normal, ray.direction) > 0 ? -hit.normal : hit.normal, hit.to_far_side};
}

/// The start of rays that leave a surface on the normal's side, or on the other.
Vec3 PlantRays::start_on(const Met& met, bool other_side) const {
    return other_side ? met.point + met.to_far_side - gap_ * met.normal : met.point + gap_ * met.normal;
}

Ray PlantRays::scattered_from(const Met& met, bool passes, SampleStream& random) const {
    return {start_on(met, passes),
            formulas::cosine_direction(passes ? -met.normal : met.normal, random.next())};
}

/// Light of the suns on a surface, times `front` where it falls on the normal's side and `back` on the other.
Rgb PlantRays::of_suns(const Met& met, Rgb front, Rgb back, SampleStream& random) {
    Rgb light(0.0);
    for (const PlantSky::Sun& sun : sky_.suns) {
        const Vec3 to = towards(sun, random);
        const double along = glm::dot(met.normal, to);
        const Rgb share = std::abs(along) * (along > 0 ? front : back);
        if (!(sum(share) > 0)) continue;
        if (is_lit(start_on(met, !(along > 0)), to)) light += share * sun.rgb;
    }
    return light;
}

/// Light that comes along the ray from the surface that it meets there: of suns at each surface on the way,
/// and of the sky at its end.
Rgb PlantRays::scattered(Ray ray, SurfaceHit hit, SampleStream& random) {
    Rgb light(0.0), weight(1.0);
    for (int i = 0; i < most_scatterings; ++i) {
        const Finish finish = finish_of(hit);
        const Met met = met_by(ray, hit);
        light += weight * of_suns(met, finish.reflected, finish.passed, random);
        const glm::dvec2 choice = random.next();
        const bool passes = scatter(weight, finish, choice.x);
        // Russian roulette: few ways go on, and count for those that do not.
        const double goes_on = std::min(1.0, sum(weight) / 3);
        if (!(goes_on > 0) || choice.y >= goes_on) return light;
        weight /= goes_on;
        ray = scattered_from(met, passes, random);
        if (!closest(ray, {}, hit)) return light + weight * sky_.radiance(ray.direction);
    }
    return light;
}

/// Follows light that an organ scatters until it has left the plant or little is left of it.
void PlantRays::follow(Ray ray, Rgb weight, SampleStream& random, OrganSample& sample) {
    const double enough = little_left * mean(weight);
    for (int i = 0; i < most_scatterings && mean(weight) > enough; ++i) {
        SurfaceHit hit;
        if (!closest(ray, {}, hit)) {
            (ray.direction.y > 0 ? sample.to_sky : sample.to_ground) += mean(weight);
            return;
        }
        const Met met = met_by(ray, hit);
        const double before = mean(weight);
        const bool passes = scatter(weight, finish_of(hit), random.next().x);
        sample.taken += before - mean(weight);
        ray = scattered_from(met, passes, random);
    }
    sample.left += mean(weight);
}

OrganSample PlantRays::sample(const OrganSurface& organ, std::uint64_t seed, std::uint32_t index) {
    // Ways differ in length: their numbers are apart from those that each sample needs.
    SampleStream random(seed, index), of_ways(CounterRandom::scrambled(seed), index);
    traversal_.begin_path();
    OrganSample sample;
    auto [point, normal] = organ.at(random.next());
    // Rays start as near to what is flat as may be: organs that touch it shade it.
    const double lift = organ.is_flat() ? organ.thickness() + gap_ : std::max(gap_, organ.thickness());
    // The ray from just outside meets what is drawn there.
    Finish finish;
    SurfaceHit hit;
    if (closest({point + lift * normal, -normal}, {0, 2 * lift}, hit)) {
        finish = finish_of(hit);
        if (!organ.is_flat()) point += (lift - hit.t) * normal;
    }
    const double start = organ.is_flat() ? lift : gap_;
    Rgb direct[2] = {Rgb(0.0), Rgb(0.0)}, all[2] = {Rgb(0.0), Rgb(0.0)};
    for (std::size_t side = 0; side < (organ.is_flat() ? 2u : 1u); ++side) {
        const Vec3 pole = side == 0 ? normal : -normal;
        const Vec3 from = point + start * pole;
        Ray ray{from, formulas::cosine_direction(pole, random.next())};
        if (closest(ray, {}, hit))
            all[side] = scattered(ray, hit, of_ways);
        else
            direct[side] = sky_.radiance(ray.direction);
        for (const PlantSky::Sun& sun : sky_.suns) {
            const Vec3 to = towards(sun, random);
            const double along = glm::dot(pole, to);
            if (!(along > 0) || !is_lit(from, to)) continue;
            direct[side] += along * sun.rgb;
            if (&sun == sky_.suns.data()) sample.sunlit = true;
        }
        all[side] += direct[side];
        sample.direct += mean(direct[side]);
        sample.light += mean(all[side]);
        sample.absorbed += mean((Rgb(1.0) - finish.reflected - finish.passed) * all[side]);
    }
    const Rgb in_front = finish.reflected * direct[0] + finish.passed * direct[1],
              behind = finish.reflected * direct[1] + finish.passed * direct[0];
    const double front = mean(in_front), back = mean(behind);
    sample.taken = sample.direct - front - back;
    if (!(front + back > 0)) return sample;
    const bool is_behind = random.next().x * (front + back) < back;
    const Vec3 pole = is_behind ? -normal : normal;
    const Rgb leaves = is_behind ? (front + back) / back * behind : (front + back) / front * in_front;
    follow({point + start * pole, formulas::cosine_direction(pole, random.next())}, leaves, of_ways, sample);
    return sample;
}

} // namespace graftal
