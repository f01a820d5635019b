#include "runtime/trace/shade.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>

#include "compiler/scene/ground.h"
#include "compiler/support/axes_across.h"
#include "compiler/support/number_range.h"
#include "runtime/trace/sky_choice.h"

namespace graftal {

namespace {

/// max_trace_level of what is emitted.
constexpr unsigned most_surfaces = 32;
/// Which lie one behind the other before a light: more are as good as a wall.
constexpr int most_panes = 1000;
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

/// The weights of POV-Ray's grey.
constexpr Rgb povray_grey(0.297, 0.589, 0.114);

/// What a surface makes of white light on its way through. An interior that absorbs has the colour in itself.
Rgb colour_of_pane(const Material& material, Rgb rgb) {
    return material.transparency * (material.absorption > 0 ? Rgb(1.0) : rgb);
}

double finite_or_zero(double value) {
    return std::isfinite(value) ? value : 0;
}

double largest(Rgb rgb) {
    return std::max({rgb.r, rgb.g, rgb.b});
}

} // namespace

/// A point of a surface as the viewer sees it, and what becomes of light there.
struct Shader::Point {
    Vec3 position;
    Vec3 normal; ///< towards the viewer
    Vec3 to_viewer;
    Rgb rgb;
    const Material* material;
    const Inside* inside; ///< on the viewer's side
    Rgb mirrored{0.0};    ///< share of light that is
    double mirrors = 0;   ///< how much that counts
    double body = 1;      ///< share of what scatters by the surface's colour
    Rgb through{0.0};     ///< share that goes through
    double shone_on = 1;  ///< share of what shines on it that is left (SurfaceHit::light_share)
};

/// A way that light may have come, seen from the camera.
struct Shader::Path {
    Ray ray;
    Rgb weight{1.0};
    double counts = 1; ///< how much it counts, for POV-Ray's bailout; no haze takes from that
    RayRange range;
    unsigned surfaces = 0, bounces = 0;
    Inside inside;
};

/// A ray's way on from a surface.
struct Shader::Way {
    Rgb share;
    double counts;  ///< 0: there is none
    Vec3 direction; ///< of any length

    /// Of several, with this chance.
    void choose(double chance) {
        share /= chance;
        counts /= chance;
    }

    /// False where degenerate normals lead nowhere.
    bool lead(Path& path, Vec3 from) const {
        if (!(counts > 0)) return false;
        path.weight *= share;
        path.counts *= counts;
        path.ray = {from, glm::normalize(direction)};
        return is_finite(path.ray.direction);
    }
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
    const bool ground_is_clear = view.ground && view.ground->material.is_transparent();
    all_opaque_ = surfaces.all_opaque() && !ground_is_clear;
    if (ground_is_clear && view.camera.location.y < view.ground->height)
        camera_inside_.cross(interior_of(view.ground->material));
    if (view.ground && ground_texture_) picture_from_world_ = inverse(world_from_picture(*view.ground));
    const Camera& camera = view.camera;
    const double width =
        camera.orthographic ? camera.width : 2 * std::tan(camera.angle_deg * std::numbers::pi / 360);
    pixel_ = width / view.size.width;
    sky_slope_ = 1 / (view.sky.to - view.sky.from);
}

Shader::~Shader() = default;

Rgb Shader::radiance(const Ray& ray, SampleStream& random, SurfaceHit* first) {
    if (first) *first = {};
    Path path;
    path.ray = ray;
    path.inside = camera_inside_;
    Rgb sum = follow(path, random, first);
    while (!waiting_.empty()) {
        path = waiting_.back();
        waiting_.pop_back();
        sum += follow(path, random);
    }
    return {finite_or_zero(sum.x), finite_or_zero(sum.y), finite_or_zero(sum.z)};
}

/// The light that comes along a path, without what waits then.
Rgb Shader::follow(Path& path, SampleStream& random, SurfaceHit* first) {
    Rgb sum(0.0);
    const unsigned most = most_surfaces + bounces_;
    for (; path.surfaces < most && path.counts >= limits_.least_weight; ++path.surfaces) {
        SurfaceHit hit;
        const bool found = closest(path.ray, path.range, hit);
        if (first && path.surfaces == 0 && found) *first = hit;
        double caught = 0; // of what lies behind the catcher
        if (view_.catcher) {
            RayRange before = path.range;
            before.most = found ? hit.t : limits_.farthest;
            caught = meet_catcher(path.ray, before, hit);
        }
        if (view_.haze) {
            const double length = found || caught > 0 ? hit.t : std::min(limits_.farthest, largest_size);
            const double left = view_.haze->left_after(path.ray.origin, path.ray.direction, length);
            sum += (1 - left) * path.weight * view_.haze->rgb;
            path.weight *= left;
        }
        if (caught > 0) {
            path.weight *= path.inside.left_after(hit.t);
            const Point point = point_of(path, hit);
            sum += caught * path.weight * lit(point, random);
            path.weight *= 1 - caught;
            path.counts *= 1 - caught;
            path.ray.origin = point.position;
            path.range.least = least_distance(point.position, mirror_pixels);
            continue;
        }
        if (!found) {
            // The surfaces that light is scattered by have taken the sky's already.
            if (path.bounces == 0) sum += path.weight * sky(path.ray.direction);
            break;
        }
        path.weight *= path.inside.left_after(hit.t);
        const Point point = point_of(path, hit);
        sum += path.weight * lit(point, random);
        if (!goes_on(path, point, random)) break;
        path.range.least = least_distance(point.position, path.bounces > 0 ? shadow_pixels : mirror_pixels);
    }
    return sum;
}

/// The way on from a surface, backwards along the light: its refracted ray, while the mirrored one waits.
/// Where light may bounce, or has, it is one of them or one by the cosine, each with the chance that its
/// light is of the three. False at the end.
bool Shader::goes_on(Path& path, const Point& point, SampleStream& random) {
    const double along = glm::dot(point.to_viewer, point.normal);
    const Material& material = *point.material;
    Way mirror{point.mirrored, point.mirrors, 2 * along * point.normal - point.to_viewer};
    Way pane{point.through, largest(point.through), Vec3(0.0)};
    Inside beyond;
    if (pane.counts > 0) {
        beyond = *point.inside;
        const double ratio = beyond.cross(interior_of(material));
        const double square = 1 + ratio * ratio * (along * along - 1);
        if (square < 0) {
            // All of it is reflected, none coloured.
            mirror = {Rgb(1.0), pane.counts, mirror.direction};
            pane.counts = 0;
        } else {
            pane.direction = (ratio * along - std::sqrt(square)) * point.normal - ratio * point.to_viewer;
        }
    }
    const double scattered =
        path.bounces < bounces_
            ? point.shone_on * point.body * (material.diffuse + material.translucency) * largest(point.rgb)
            : 0;
    if (scattered > 0 || (path.bounces > 0 && mirror.counts > 0 && pane.counts > 0)) {
        const glm::dvec2 choice = random.next();
        const double all = mirror.counts + pane.counts + scattered;
        // The weight tells how much of the path's light there is left to look for.
        const double going_on = std::min(1.0, all);
        if (choice.x >= going_on) return false;
        const double mirror_chance = going_on * mirror.counts / all;
        const double pane_chance = going_on * pane.counts / all;
        const double scatter_chance = scattered > 0 ? going_on - mirror_chance - pane_chance : 0;
        if (choice.x < scatter_chance) {
            path.counts *= scattered / scatter_chance;
            path.weight /= scatter_chance;
            return scatter(path, point, choice.y, random);
        }
        const bool mirrors = !(pane_chance > 0) || choice.x < scatter_chance + mirror_chance;
        (mirrors ? mirror : pane).choose(mirrors ? mirror_chance : pane_chance);
        (mirrors ? pane : mirror).counts = 0;
    }
    if (mirror.counts > 0 && pane.counts > 0) {
        Path other = path;
        ++other.surfaces;
        other.range.least = least_distance(point.position, mirror_pixels);
        if (mirror.lead(other, point.position) && other.counts >= limits_.least_weight)
            waiting_.push_back(other);
    }
    if (pane.counts > 0) path.inside = beyond;
    return (pane.counts > 0 ? pane : mirror).lead(path, point.position);
}

/// By the cosine, to either side. `choice`: of the side, in [0, 1).
bool Shader::scatter(Path& path, const Point& point, double choice, SampleStream& random) const {
    const double through = point.material->translucency, diffuse = point.material->diffuse + through;
    path.weight *= point.shone_on * point.body * diffuse * point.rgb;
    const Vec3 pole = choice * diffuse < through ? -point.normal : point.normal;
    path.ray = {point.position, cosine_direction(pole, random.next())};
    ++path.bounces;
    return is_finite(path.ray.direction);
}

bool Shader::first_hit(const Ray& ray, SurfaceHit& hit) {
    return closest(ray, {}, hit);
}

bool Shader::closest(const Ray& ray, RayRange range, SurfaceHit& hit) {
    range.most = std::min(range.most, limits_.farthest);
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

Shader::Point Shader::point_of(const Path& path, const SurfaceHit& hit) const {
    Point point{path.ray(hit.t), hit.normal, -path.ray.direction, hit.rgb, hit.material, &path.inside};
    if (glm::dot(hit.normal, path.ray.direction) > 0) point.normal = -hit.normal;
    // Exactly on the ground, its own shadow cannot begin on the way to a low sun.
    if (view_.ground && hit.material == &view_.ground->material) point.position.y = view_.ground->height;
    if (hit.material == &catcher_paper_) point.position.y = view_.catcher->centre.y;
    point.shone_on = hit.light_share;
    share_light(point);
    return point;
}

void Shader::share_light(Point& point) const {
    const Material& material = *point.material;
    const double cosine = std::min(1.0, glm::dot(point.to_viewer, point.normal));
    point.mirrors = material.reflection;
    if (material.has_coat()) {
        if (point.mirrors > 0)
            point.mirrors *= fresnel(point.inside->relative_ior(interior_of(material)), cosine);
        // POV-Ray leaves out what lies below a coat that is all but a mirror.
        point.body = 1 - point.mirrors > limits_.least_weight ? 1 - point.mirrors : 0;
    }
    point.mirrored = Rgb(point.mirrors);
    if (point.mirrors > 0 && material.metallic > 0)
        point.mirrored *= metal_colour(material.metallic, point.rgb, cosine);
    if (!material.is_transparent()) return;
    point.through = colour_of_pane(material, point.rgb) *
                    (material.has_coat() ? Rgb(point.body) : Rgb(1.0) - point.mirrored);
    if (!(glm::dot(povray_grey, point.through) > limits_.least_weight)) point.through = Rgb(0.0);
    point.body *= 1 - material.transparency;
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
    Rgb sum = point.body * point.material->ambient * ambient_light_ * point.rgb;
    if (point.material->emission > 0) sum += point.body * point.material->emission * point.rgb;
    Rgb shining(0.0);
    for (const Lamp& lamp : lamps_)
        shining += light_of(lamp, point, least);
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
        shining += light_of(part, point, least);
    }
    if (sky_) shining += from_sky(point, least, random);
    return sum + point.shone_on * shining;
}

Rgb Shader::from_sky(const Point& point, double least, SampleStream& random) {
    const Material& material = *point.material;
    const double front = point.body * material.diffuse + material.specular;
    const double back = point.body * material.translucency;
    if (!(front + back > 0)) return Rgb(0.0);
    const SkyChoice choice{front / (front + back), material.specular > 0};
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
    Rgb share = point.body * (behind ? -material.translucency : material.diffuse) * along * point.rgb;
    if (!behind && choice.shines) share += shine(point, direction);
    if (!(largest(share) > 0)) return Rgb(0.0);
    const Rgb light = sky_->radiance(direction);
    if (!(largest(light) > 0)) return Rgb(0.0);
    double density_pi = choice.density_pi(along);
    if (bright_sky_)
        density_pi += std::numbers::pi * bright_sky_->density(sky_->picture_from_world * direction);
    if (!(density_pi > 0)) return Rgb(0.0);
    return share / density_pi * light * light_through({point.position, direction}, {least}, *point.inside);
}

/// The specular share of a light from there.
Rgb Shader::shine(const Point& point, Vec3 to_light) const {
    const Material& material = *point.material;
    if (!(material.specular > 0)) return Rgb(0.0);
    const Vec3 halfway = point.to_viewer + to_light;
    const double glint = glm::dot(halfway, point.normal) / glm::length(halfway);
    const double exponent = 1 / std::max(material.roughness, least_roughness);
    // x^n <= e^(n (x - 1)): most points are far from any highlight.
    if (!(glint > 0 && exponent * (1 - glint) < dark_exponent)) return Rgb(0.0);
    const double share = material.specular * std::pow(glint, exponent);
    if (!(material.metallic > 0)) return Rgb(share);
    return share * metal_colour(material.metallic, point.rgb, glm::dot(to_light, point.normal));
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
    Rgb share = point.body * (behind ? -material.translucency : material.diffuse) * cosine * point.rgb;
    if (!lamp.shadowless && !behind) share += shine(point, to_light.direction);
    if (!(largest(share) > 0)) return Rgb(0.0);
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

Rgb Shader::sky(Vec3 direction) const {
    if (view_.shows_sky_light) return view_.sky_light->radiance(direction);
    const Sky& sky = view_.sky;
    if (sky.zenith == sky.horizon) return sky.zenith;
    const double height = (glm::dot(direction, sky.axis) - sky.from) * sky_slope_;
    const double t = height > 0 ? std::min(height, most_zenith) : 0;
    return (1 - t) * sky.horizon + t * sky.zenith;
}

} // namespace graftal
