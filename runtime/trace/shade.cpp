#include "runtime/trace/shade.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>

#include "compiler/scene/ground.h"
#include "compiler/support/axes_across.h"
#include "compiler/support/number_range.h"

namespace graftal {

namespace {

/// max_trace_level of what is emitted; where nothing reflects, POV-Ray's own 5 makes no difference.
constexpr int most_surfaces = 8;
/// POV-Ray takes smaller cosines and lights for 0 (its EPSILON).
constexpr double least_cosine = 1e-10;
constexpr double least_light = 1e-10;
/// What is emitted is no smoother (povray_textures.cpp).
constexpr double least_roughness = 5e-4;
/// The share of a zenith that the emitted sky reaches (povray_view.cpp).
constexpr double most_zenith = 0.999999;
/// e to the minus this is nothing, even of the brightest light.
constexpr double dark_exponent = 40;
/// How close to where they start rays meet nothing: in pixels, a tenth of that for mirrors as in POV-Ray, and
/// in rounding errors of the coordinates. Where two surfaces touch, light leaks through so narrow a gap.
constexpr double shadow_pixels = 1e-3;
constexpr double mirror_pixels = 1e-4;
constexpr double least_share = 1e-12;

bool is_finite(Vec3 v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

double finite_or_zero(double value) {
    return std::isfinite(value) ? value : 0;
}

double largest(Rgb rgb) {
    return std::max({rgb.r, rgb.g, rgb.b});
}

Vec3 from_pole(Vec3 pole, double along, double turn) {
    const auto [a, b] = axes_across(pole);
    const double radius = std::sqrt(std::max(0.0, 1 - along * along));
    return along * pole + radius * (std::cos(turn) * a + std::sin(turn) * b);
}

/// Of the half about a unit normal: its density is the cosine over pi.
Vec3 cosine_direction(Vec3 normal, glm::dvec2 place) {
    return from_pole(normal, std::sqrt(1 - place.x), 2 * std::numbers::pi * place.y);
}

/// Its density is 1 / (2 pi).
Vec3 even_direction(Vec3 normal, glm::dvec2 place) {
    return from_pole(normal, 1 - place.x, 2 * std::numbers::pi * place.y);
}

} // namespace

/// A point of a surface as the viewer sees it.
struct Shader::Point {
    Vec3 position;
    Vec3 normal; ///< towards the viewer
    Vec3 to_viewer;
    Rgb rgb;
    const Material* material;
};

Shader::Shader(const View& view, Surfaces& surfaces, const ShaderLimits& limits,
               std::shared_ptr<const Texture> ground_texture)
    : view_(view), surfaces_(surfaces), limits_(limits), ground_texture_(std::move(ground_texture)) {
    const bool listed = limits.list.has_value();
    for (const Light& light : listed ? listed_lights(view, *limits.list) : view.lights) {
        if (largest(light.rgb) < least_light) continue;
        const Vec3 at = light.sun ? glm::normalize(light.location) : light.location;
        if (!is_finite(at)) continue;
        const Lamp lamp{at, light.rgb, light.sun, light.shadowless};
        if (light.is_area()) {
            areas_.push_back({lamp, light.a, light.b, light.round});
        } else if (light.is_disc()) {
            const auto [a, b] = axes_across(at);
            const double radius = std::tan(0.5 * light.angle_deg * std::numbers::pi / 180);
            areas_.push_back({lamp, radius * a, radius * b, true});
        } else {
            lamps_.push_back(lamp);
        }
    }
    if (view.sky_light) {
        ambient_light_ = view.ambient_light();
        if (!listed) {
            sky_ = &*view.sky_light;
            if (sky_->picture && sky_->picture->sampling().any()) bright_sky_ = &sky_->picture->sampling();
            bounces_ = sky_->bounces;
            if (bounces_ > 0) ambient_light_ = Rgb(0.0);
        }
    } else {
        ambient_light_ = Rgb(1.0);
    }
    if (view.catcher) {
        catcher_paper_.rgb = view.catcher->rgb;
        catcher_paper_.ambient = 0;
        catcher_paper_.diffuse = 1;
        catcher_paper_.specular = 0;
    }
    if (view.ground && ground_texture_) picture_from_world_ = inverse(world_from_picture(*view.ground));
    const Camera& camera = view.camera;
    const double width =
        camera.orthographic ? camera.width : 2 * std::tan(camera.angle_deg * std::numbers::pi / 360);
    pixel_ = width / view.size.width;
    sky_slope_ = 1 / (view.sky.to - view.sky.from);
}

Rgb Shader::radiance(const Ray& ray, SampleStream& random, SurfaceHit* first) {
    if (first) *first = {};
    Rgb sum(0.0), weight(1.0);
    Ray path = ray;
    RayRange range;
    unsigned bounces = 0;
    const unsigned most = most_surfaces + bounces_;
    double clear = 1; // the share that the air leaves
    for (unsigned surface = 0; surface < most && largest(weight) >= limits_.least_weight; ++surface) {
        SurfaceHit hit;
        const bool found = closest(path, range, hit);
        if (first && surface == 0 && found) *first = hit;
        double caught = 0; // of what lies behind the catcher
        if (view_.catcher) {
            RayRange before = range;
            before.most = found ? hit.t : limits_.farthest;
            caught = meet_catcher(path, before, hit);
        }
        if (view_.haze) {
            const double length = found || caught > 0 ? hit.t : std::min(limits_.farthest, largest_size);
            const double left = view_.haze->left_after(path.origin, path.direction, length);
            sum += clear * (1 - left) * weight * view_.haze->rgb;
            clear *= left;
        }
        if (caught > 0) {
            const Point point = point_of(path, hit);
            sum += caught * clear * weight * lit(point, random);
            weight *= 1 - caught;
            path.origin = point.position;
            range.least = least_distance(point.position, mirror_pixels);
            continue;
        }
        if (!found) {
            // The surfaces that light is scattered by have taken the sky's already.
            if (bounces == 0) sum += clear * weight * sky(path.direction);
            break;
        }
        const Point point = point_of(path, hit);
        sum += clear * weight * lit(point, random);
        if (!bounce(point, bounces, path, weight, random)) break;
        range.least = least_distance(point.position, bounces > 0 ? shadow_pixels : mirror_pixels);
    }
    return {finite_or_zero(sum.x), finite_or_zero(sum.y), finite_or_zero(sum.z)};
}

/// The way on from a surface, backwards along the light: its mirrored ray, or where bounces are left one by
/// the cosine, each with the chance that its light is of the two. False at the end.
bool Shader::bounce(const Point& point, unsigned& bounces, Ray& path, Rgb& weight,
                    SampleStream& random) const {
    const double mirrored = point.material->reflection;
    const double through = point.material->translucency, diffuse = point.material->diffuse + through;
    const Rgb scattered = bounces < bounces_ ? diffuse * point.rgb : Rgb(0.0);
    const double most = largest(scattered);
    if (!(mirrored + most > 0)) return false;
    if (most > 0) {
        const glm::dvec2 choice = random.next();
        // The weight tells how much of the path's light there is left to look for.
        const double going_on = std::min(1.0, mirrored + most);
        if (choice.x >= going_on) return false;
        const double chance = going_on * mirrored / (mirrored + most);
        if (choice.x >= chance) {
            weight *= scattered / (going_on - chance);
            const bool behind = choice.y * diffuse < through;
            const Vec3 pole = behind ? -point.normal : point.normal;
            path = {point.position, cosine_direction(pole, random.next())};
            ++bounces;
            return is_finite(path.direction);
        }
        weight /= chance;
    }
    weight *= mirrored;
    const double along = glm::dot(point.to_viewer, point.normal);
    path = {point.position, glm::normalize(2 * along * point.normal - point.to_viewer)};
    return is_finite(path.direction); // degenerate normals mirror nothing
}

bool Shader::first_hit(const Ray& ray, SurfaceHit& hit) {
    return closest(ray, {}, hit);
}

bool Shader::closest(const Ray& ray, RayRange range, SurfaceHit& hit) {
    range.most = limits_.farthest;
    const bool found = surfaces_.closest(ray, range, hit);
    if (!view_.ground) return found;
    if (found) range.most = hit.t;
    double t = 0;
    if (!meet_ground(ray, range, t)) return found;
    hit = {t, {0, 1, 0}, view_.ground->material.rgb, &view_.ground->material};
    if (ground_texture_) {
        const auto& srgb = ground_texel(ray(t)).srgb;
        hit.rgb = {srgb_decoded(srgb[0]), srgb_decoded(srgb[1]), srgb_decoded(srgb[2])};
    }
    return true;
}

/// The opacity of the catcher where the ray meets it, in front of what else it meets; 0: nowhere.
double Shader::meet_catcher(const Ray& ray, const RayRange& range, SurfaceHit& hit) const {
    double t = 0;
    if (!meet_level(view_.catcher->centre.y, ray, range, t)) return 0;
    const double opacity = view_.catcher->opacity(ray(t));
    if (opacity > 0) hit = {t, {0, 1, 0}, catcher_paper_.rgb, &catcher_paper_};
    return opacity;
}

bool Shader::meet_level(double height, const Ray& ray, const RayRange& range, double& t) {
    if (!(std::abs(ray.direction.y) >= least_cosine)) return false;
    t = (height - ray.origin.y) / ray.direction.y;
    return range.least < t && t < range.most;
}

bool Shader::meet_ground(const Ray& ray, const RayRange& range, double& t) const {
    if (!meet_level(view_.ground->height, ray, range, t)) return false;
    return !ground_texture_ || !ground_texel(ray(t)).clear;
}

const Texture::Texel& Shader::ground_texel(Vec3 point) const {
    const Vec3 place = picture_from_world_(point);
    return ground_texture_->at(place.x, place.y);
}

Shader::Point Shader::point_of(const Ray& ray, const SurfaceHit& hit) const {
    Point point{ray(hit.t), hit.normal, -ray.direction, hit.rgb, hit.material};
    if (glm::dot(hit.normal, ray.direction) > 0) point.normal = -hit.normal;
    // Exactly on the ground, its own shadow cannot begin on the way to a low sun.
    if (view_.ground && hit.material == &view_.ground->material) point.position.y = view_.ground->height;
    if (hit.material == &catcher_paper_) point.position.y = view_.catcher->centre.y;
    return point;
}

/// POV-Ray's own, 1e-3 and 1e-4 of its units, are of that order in a picture of 1000 pixels. Beside and
/// behind a perspective camera, where reflections lie, the distance to the eye stands for the depth. Rounding
/// errors of the coordinates are below it in any case.
double Shader::least_distance(Vec3 point, double pixels) const {
    const Camera& camera = view_.camera;
    const Vec3 sight = point - camera.location;
    const double distance = glm::length(sight);
    double pixel = pixel_;
    if (!camera.orthographic) {
        const double depth = glm::dot(sight, camera.direction);
        pixel *= depth > 0 ? depth * (depth / distance) : distance;
    }
    return std::max(pixels * pixel, least_share * (largest_entry(point) + distance));
}

Rgb Shader::lit(const Point& point, SampleStream& random) {
    const double least = least_distance(point.position, shadow_pixels);
    Rgb sum = point.material->ambient * ambient_light_ * point.rgb;
    if (point.material->emission > 0) sum += point.material->emission * point.rgb;
    for (const Lamp& lamp : lamps_)
        sum += light_of(lamp, point, least);
    for (const Area& area : areas_) {
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
        sum += light_of(part, point, least);
    }
    if (sky_) sum += from_sky(point, least, random);
    return sum;
}

/// How a surface chooses a direction towards the sky, by the cosine: of the half that it faces, or of the
/// other if light comes through; if it shines, by half evenly.
struct Shader::SkyChoice {
    double front_chance = 1;
    bool shines = false;

    Vec3 direction(Vec3 normal, glm::dvec2 place) const {
        const bool behind = place.x >= front_chance;
        place.x = behind ? (place.x - front_chance) / (1 - front_chance) : place.x / front_chance;
        if (behind) return cosine_direction(-normal, place);
        const bool even = shines && place.x < 0.5;
        if (shines) place.x = even ? 2 * place.x : 2 * place.x - 1;
        return even ? even_direction(normal, place) : cosine_direction(normal, place);
    }

    /// A steradian, times pi. `along`: the cosine with the normal.
    double density_pi(double along) const {
        if (along < 0) return (1 - front_chance) * -along;
        return front_chance * (shines ? 0.5 * along + 0.25 : along);
    }
};

Rgb Shader::from_sky(const Point& point, double least, SampleStream& random) {
    const Material& material = *point.material;
    const double front = material.diffuse + material.specular;
    if (!(front + material.translucency > 0)) return Rgb(0.0);
    const SkyChoice choice{front / (front + material.translucency), material.specular > 0};
    Rgb light = sky_light(choice, point, choice.direction(point.normal, random.next()), least);
    if (bright_sky_)
        light +=
            sky_light(choice, point, bright_sky_->direction(random.next()) * sky_->picture_from_world, least);
    return light;
}

/// Of the sky in one direction, over what the strategies that may have chosen it give to it.
Rgb Shader::sky_light(const SkyChoice& choice, const Point& point, Vec3 direction, double least) {
    const Material& material = *point.material;
    const double along = glm::dot(point.normal, direction);
    if (!(std::abs(along) >= least_cosine)) return Rgb(0.0);
    const bool behind = along < 0;
    Rgb share = (behind ? -material.translucency : material.diffuse) * along * point.rgb;
    if (!behind && choice.shines) share += shine(point, direction);
    if (!(largest(share) > 0)) return Rgb(0.0);
    const Rgb light = sky_->radiance(direction);
    if (!(largest(light) > 0)) return Rgb(0.0);
    double density_pi = choice.density_pi(along);
    if (bright_sky_)
        density_pi += std::numbers::pi * bright_sky_->density(sky_->picture_from_world * direction);
    if (!(density_pi > 0) || shadowed({point.position, direction}, {least})) return Rgb(0.0);
    return share / density_pi * light;
}

/// The specular share of a light from there.
double Shader::shine(const Point& point, Vec3 to_light) const {
    const Material& material = *point.material;
    if (!(material.specular > 0)) return 0;
    const Vec3 halfway = point.to_viewer + to_light;
    const double glint = glm::dot(halfway, point.normal) / glm::length(halfway);
    const double exponent = 1 / std::max(material.roughness, least_roughness);
    // x^n <= e^(n (x - 1)): most points are far from any highlight.
    if (!(glint > 0 && exponent * (1 - glint) < dark_exponent)) return 0;
    return material.specular * std::pow(glint, exponent);
}

Rgb Shader::light_of(const Lamp& lamp, const Point& point, double least) {
    const Material& material = *point.material;
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
    Rgb share = (behind ? -material.translucency : material.diffuse) * cosine * point.rgb;
    if (!lamp.shadowless && !behind) share += shine(point, to_light.direction);
    if (!(largest(share) > 0)) return Rgb(0.0);
    if (!lamp.shadowless && shadowed(to_light, range)) return Rgb(0.0);
    return share * lamp.rgb;
}

bool Shader::shadowed(const Ray& to_light, const RayRange& range) {
    if (!(range.least < range.most)) return false;
    double t = 0;
    if (view_.ground && meet_ground(to_light, range, t)) return true;
    return surfaces_.meets_any(to_light, range);
}

Rgb Shader::sky(Vec3 direction) const {
    if (view_.shows_sky_light) return view_.sky_light->radiance(direction);
    const Sky& sky = view_.sky;
    if (sky.zenith == sky.horizon) return sky.zenith;
    const double height = (glm::dot(direction, sky.axis) - sky.from) * sky_slope_;
    const double t = height > 0 ? std::min(height, most_zenith) : 0;
    return (1 - t) * sky.horizon + t * sky.zenith;
}

} // namespace graftal
