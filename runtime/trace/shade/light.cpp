// The light that a surface sends to the viewer, of its own and of what shines on it.

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "runtime/trace/shade/formulas.h"
#include "runtime/trace/shade/point.h"

namespace graftal {

namespace {

/// Most surfaces one behind the other before a light: more are as good as a wall.
constexpr int most_panes = 1000;
/// e to the minus this is nothing, even of the brightest light.
constexpr double dark_exponent = 40;

} // namespace

Rgb Shader::lit(const Point& point, bool sky_later, SampleStream& random) {
    work_ += work_of_a_point_;
    const double least = least_distance(point.position, shadow_pixels);
    Rgb sum = point.body * point.material->ambient * ambient_light_ * point.rgb;
    if (point.material->emission > 0) sum += point.body * point.material->emission * point.rgb;
    Rgb shining = of_lamps(point, least, random);
    if (sky_) shining += from_sky(point, least, sky_later, random);
    return sum + point.shone_on * shining;
}

Rgb Shader::light_of_lamps(const Ray& ray, const SurfaceHit& first, SampleStream& random) {
    if (lamps_.empty() && areas_.empty()) return Rgb(0.0);
    const Point point = point_of(ray, camera_inside_, first, random);
    return point.shone_on * of_lamps(point, least_distance(point.position, shadow_pixels), random);
}

Rgb Shader::of_lamps(const Point& point, double least, SampleStream& random) {
    Rgb shining(0.0);
    for (const Lamp& lamp : lamps_)
        shining += light_of(lamp, point, least);
    for (const Area& area : areas_)
        shining += light_of(part_of(area, random), point, least);
    return shining;
}

/// One point of an area by chance.
Shader::Lamp Shader::part_of(const Area& area, SampleStream& random) {
    glm::dvec2 place = random.next();
    if (area.round) {
        const double radius = std::sqrt(place.x), turn = 2 * std::numbers::pi * place.y;
        place = {radius * std::cos(turn), radius * std::sin(turn)};
    } else {
        place = 2.0 * place - 1.0;
    }
    Lamp part = area.middle;
    part.at += place.x * area.a + place.y * area.b;
    if (part.sun) part.at = glm::normalize(part.at);
    return part;
}

/// `shine_only`: without what is scattered.
Rgb Shader::from_sky(const Point& point, double least, bool shine_only, SampleStream& random) {
    const double body = shine_only ? 0 : point.body;
    const double front = body * point.material->diffuse + point.specular;
    const double back = body * point.material->translucency;
    if (!(front + back > 0)) return Rgb(0.0);
    const double front_chance = front / (front + back);
    const bool shines = point.specular > 0;
    Rgb light = sky_light(front_chance, point, body,
                          formulas::sky_choice(front_chance, shines, point.normal, random.next()), least);
    if (bright_sky_)
        light += sky_light(front_chance, point, body,
                           bright_sky_->direction(random.next()) * sky_->picture_from_world, least);
    return light;
}

/// Light of the sky in one direction, over its density by the strategies that may have chosen it.
Rgb Shader::sky_light(double front_chance, const Point& point, double body, Vec3 direction, double least) {
    const bool shines = point.specular > 0;
    const double along = glm::dot(point.normal, direction);
    if (!(std::abs(along) >= least_cosine)) return Rgb(0.0);
    const bool behind = along < 0;
    Rgb share = body * scattered(point, along) * point.rgb;
    if (!behind && shines) share += shine(point, direction);
    if (!(largest(share) > 0)) return Rgb(0.0);
    const Rgb light = sky_->radiance(direction);
    if (!(largest(light) > 0)) return Rgb(0.0);
    double density_pi = formulas::sky_choice_density_pi(front_chance, shines, along);
    if (bright_sky_)
        density_pi += std::numbers::pi * bright_sky_->density(sky_->picture_from_world * direction);
    if (!(density_pi > 0)) return Rgb(0.0);
    const Vec3 from = behind ? point.far_side : point.position;
    return share / density_pi * light * light_through({from, direction}, {least}, *point.inside);
}

/// The share of a light that scatters to the viewer, without its colour. `cosine`: to the light, below 0
/// behind.
double Shader::scattered(const Point& point, double cosine) {
    const Material& material = *point.material;
    return (cosine < 0 ? material.translucency : material.diffuse) *
           formulas::lit_cosine(std::abs(cosine), point.facing);
}

/// The specular share of a light from there.
Rgb Shader::shine(const Point& point, Vec3 to_light) const {
    if (!(point.specular > 0)) return Rgb(0.0);
    const Vec3 halfway = point.to_viewer + to_light;
    const double glint = glm::dot(halfway, point.normal) / glm::length(halfway);
    const double exponent = 1 / point.roughness;
    // x^n <= e^(n (x - 1)): most points are far from any highlight.
    if (!(glint > 0 && exponent * (1 - glint) < dark_exponent)) return Rgb(0.0);
    const double share = point.specular * std::pow(glint, exponent);
    const double metallic = point.material->metallic;
    if (!(metallic > 0)) return Rgb(share);
    return share * formulas::metal_colour(metallic, point.rgb, glm::dot(to_light, point.normal));
}

Rgb Shader::light_of(const Lamp& lamp, const Point& point, double least) {
    Ray to_light{point.position, lamp.at};
    RayRange range{least};
    if (!lamp.sun) {
        const Vec3 way = lamp.at - point.position;
        const double distance = glm::length(way);
        to_light.direction = way / distance;
        range.most = distance - least;
    }
    const double cosine = glm::dot(point.normal, to_light.direction);
    // Also if the cosine is not a number, as of a light that lies on the surface.
    if (!(std::abs(cosine) >= least_cosine)) return Rgb(0.0);
    const bool behind = cosine < 0;
    Rgb share = point.body * scattered(point, cosine) * point.rgb;
    if (!lamp.shadowless && !behind) share += shine(point, to_light.direction);
    if (!(largest(share) > 0)) return Rgb(0.0);
    if (behind) to_light.origin = point.far_side;
    if (!lamp.shadowless) share *= light_through(to_light, range, *point.inside);
    return share * lamp.rgb;
}

/// The share of a light that comes straight through what is in its way.
Rgb Shader::light_through(Ray to_light, RayRange range, const Inside& start) {
    if (!(range.least < range.most)) return Rgb(1.0);
    double t = 0;
    const bool shaded =
        (view_.ground && meet_ground(to_light, range, t)) || surfaces_.meets_any(to_light, range);
    if (!shaded || all_opaque_) return Rgb(shaded ? 0.0 : 1.0);
    Inside inside = start;
    Rgb left(1.0);
    for (int pane = 0; pane < most_panes && largest(left) >= least_light; ++pane) {
        SurfaceHit hit;
        if (!(range.least < range.most) || !closest(to_light, range, hit)) return left;
        const Material& material = *hit.material;
        if (!material.is_transparent()) break;
        left *= colour_of_pane(material, hit.rgb) * inside.left_after(hit.t);
        inside.cross(interior_of(material));
        to_light.origin = to_light(hit.t);
        range.most -= hit.t;
        range.least = least_distance(to_light.origin, shadow_pixels);
    }
    return Rgb(0.0);
}

} // namespace graftal
