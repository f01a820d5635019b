#include "runtime/trace/shade.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>

#include "compiler/scene/ground.h"

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
    for (const Light& light : view.lights) {
        if (std::max({light.rgb.x, light.rgb.y, light.rgb.z}) < least_light) continue;
        const Vec3 at = light.sun ? glm::normalize(light.location) : light.location;
        if (is_finite(at)) lamps_.push_back({at, light.rgb, light.sun, light.shadowless});
    }
    if (view.ground && ground_texture_) picture_from_world_ = inverse(world_from_picture(*view.ground));
    const Camera& camera = view.camera;
    const double width =
        camera.orthographic ? camera.width : 2 * std::tan(camera.angle_deg * std::numbers::pi / 360);
    pixel_ = width / view.size.width;
    sky_slope_ = 1 / (view.sky.to - view.sky.from);
}

Rgb Shader::radiance(const Ray& ray) {
    Rgb sum(0.0);
    double weight = 1;
    Ray path = ray;
    RayRange range;
    for (int surface = 0; surface < most_surfaces && weight >= limits_.least_weight; ++surface) {
        SurfaceHit hit;
        if (!closest(path, range, hit)) {
            sum += weight * sky(path.direction);
            break;
        }
        const Point point = point_of(path, hit);
        sum += weight * lit(point);
        if (!(hit.material->reflection > 0)) break;
        weight *= hit.material->reflection;
        const double along = glm::dot(point.to_viewer, point.normal);
        path = {point.position, glm::normalize(2 * along * point.normal - point.to_viewer)};
        // Degenerate normals mirror nothing.
        if (!is_finite(path.direction)) break;
        range.least = least_distance(point.position, mirror_pixels);
    }
    return {finite_or_zero(sum.x), finite_or_zero(sum.y), finite_or_zero(sum.z)};
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

bool Shader::meet_ground(const Ray& ray, const RayRange& range, double& t) const {
    if (!(std::abs(ray.direction.y) >= least_cosine)) return false;
    t = (view_.ground->height - ray.origin.y) / ray.direction.y;
    if (!(range.least < t && t < range.most)) return false;
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

Rgb Shader::lit(const Point& point) {
    const double least = least_distance(point.position, shadow_pixels);
    Rgb sum = point.material->ambient * point.rgb;
    for (const Lamp& lamp : lamps_)
        sum += light_of(lamp, point, least);
    return sum;
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
    if (!(cosine >= least_cosine)) return Rgb(0.0);
    Rgb share = material.diffuse * cosine * point.rgb;
    if (material.specular > 0 && !lamp.shadowless) {
        const Vec3 halfway = point.to_viewer + to_light.direction;
        const double glint = glm::dot(halfway, point.normal) / glm::length(halfway);
        const double exponent = 1 / std::max(material.roughness, least_roughness);
        // x^n <= e^(n (x - 1)): most points are far from any highlight.
        if (glint > 0 && exponent * (1 - glint) < dark_exponent)
            share += material.specular * std::pow(glint, exponent);
    }
    if (std::max({share.x, share.y, share.z}) <= 0) return Rgb(0.0);
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
    const Sky& sky = view_.sky;
    if (sky.zenith == sky.horizon) return sky.zenith;
    const double height = (glm::dot(direction, sky.axis) - sky.from) * sky_slope_;
    const double t = height > 0 ? std::min(height, most_zenith) : 0;
    return (1 - t) * sky.horizon + t * sky.zenith;
}

} // namespace graftal
