#include "runtime/trace/shade/shade.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>

#include "compiler/detail/work.h"
#include "compiler/scene/ground.h"
#include "compiler/support/axes_across.h"
#include "compiler/support/number_range.h"
#include "runtime/trace/shade/formulas.h"
#include "runtime/trace/shade/patterns.h"
#include "runtime/trace/shade/point.h"

namespace graftal {

namespace {

/// The share of a zenith that the emitted sky reaches (povray/emit/view.cpp).
constexpr double most_zenith = 0.999999;
/// Distance of the start of mirrored rays, in pixels: a tenth of shadow_pixels, as in POV-Ray.
constexpr double mirror_pixels = 1e-4;
/// Least distance of a ray's start, as a share of the coordinates: some rounding errors.
constexpr double least_share = 1e-12;

bool is_finite(Vec3 v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// The weights of POV-Ray's grey.
constexpr Rgb povray_grey(0.297, 0.589, 0.114);

double finite_or_zero(double value) {
    return std::isfinite(value) ? value : 0;
}

} // namespace

/// A way that light may have come, seen from the camera.
struct Shader::Path {
    Ray ray;
    Rgb weight{1.0};
    double counts = 1; ///< how much it counts, for POV-Ray's bailout; no haze takes from that
    RayRange range;
    unsigned surfaces = 0, bounces = 0;
    bool takes_sky = true; ///< if it ends in the sky: else the surface that it was scattered by has its light
    Inside inside;
};

/// A ray's way on from a surface.
struct Shader::Way {
    Rgb share;
    double counts;  ///< 0: there is none
    Vec3 direction; ///< of any length

    /// Lessens the way from a rough surface, whose facets hide each other. `normal`: on the side of the way.
    void roughen(Vec3 normal, double blur) {
        if (!(counts > 0)) return;
        const double left = formulas::unhidden(glm::dot(glm::normalize(direction), normal), blur);
        share *= left;
        counts *= left;
    }

    /// Makes up for a way that has been chosen out of several with this chance.
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
            areas_.push_back(disc_of(light, lamp));
        } else {
            lamps_.push_back(lamp);
        }
    }
    if (const Light* sun = view.sun_of_haze(); sun && !listed)
        haze_sun_ = disc_of(*sun, {glm::normalize(sun->location), sun->rgb, true, sun->shadowless});
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
    work_of_a_point_ = RayWork::lamp * lamps_.size() + RayWork::soft_lamp * areas_.size();
    if (sky_) work_of_a_point_ += bright_sky_ ? RayWork::bright_sky : RayWork::sky;
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

Shader::Area Shader::disc_of(const Light& sun, const Lamp& middle) {
    const auto [a, b] = axes_across(middle.at);
    const double radius = std::tan(0.5 * sun.angle_deg * std::numbers::pi / 180);
    return {middle, radius * a, radius * b, true};
}

void Shader::look_ahead(std::span<const Ray> rays, Ahead& ahead) {
    ahead.met = surfaces_.closest_each(rays, {0, limits_.farthest}, ahead.hits);
}

Rgb Shader::radiance(const Ray& ray, SampleStream& random, SurfaceHit* first, const Ahead& ahead,
                     std::size_t number) {
    const Known found = known(ahead, number);
    return radiance(ray, random, first, &found);
}

Rgb Shader::radiance(const Ray& ray, SampleStream& random, SurfaceHit* first, const Known* known) {
    if (first) *first = {};
    Path path;
    path.ray = ray;
    path.inside = camera_inside_;
    Rgb sum = follow(path, random, first, known);
    while (!waiting_.empty()) {
        path = waiting_.back();
        waiting_.pop_back();
        sum += follow(path, random);
    }
    return {finite_or_zero(sum.x), finite_or_zero(sum.y), finite_or_zero(sum.z)};
}

/// The light that comes along a path, without what waits then.
Rgb Shader::follow(Path& path, SampleStream& random, SurfaceHit* first, const Known* known) {
    Rgb sum(0.0);
    const unsigned most = limits_.most_surfaces + bounces_;
    for (; path.surfaces < most && path.counts >= limits_.least_weight; ++path.surfaces) {
        SurfaceHit hit;
        const bool found = closest(path.ray, path.range, hit, path.surfaces == 0 ? known : nullptr);
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
            sum += (1 - left) * path.weight * light_of_haze(path, length, random);
            path.weight *= left;
        }
        if (caught > 0) {
            path.weight *= path.inside.left_after(hit.t);
            const Point point = point_of(path.ray, path.inside, hit, random);
            sum += caught * path.weight * lit(point, false, random);
            path.weight *= 1 - caught;
            path.counts *= 1 - caught;
            path.ray.origin = point.position;
            path.range.least = least_distance(point.position, mirror_pixels);
            continue;
        }
        if (!found) {
            if (path.takes_sky)
                sum += path.weight *
                       (path.bounces == 0 ? sky(path.ray.direction) : sky_->radiance(path.ray.direction));
            break;
        }
        path.weight *= path.inside.left_after(hit.t);
        const Point point = point_of(path.ray, path.inside, hit, random);
        const double scattered = path.bounces < bounces_ ? scattered_by(point) : 0;
        // A ray that finds either a surface or the sky tells more than one for each.
        const bool sky_later = !bright_sky_ && path.counts * scattered >= limits_.least_weight;
        sum += path.weight * lit(point, sky_later, random);
        if (!goes_on(path, point, scattered, sky_later, random)) break;
        path.range.least = least_distance(point.position, path.bounces > 0 ? shadow_pixels : mirror_pixels);
    }
    return sum;
}

/// The colour of the haze along a path of this length. Of the sun's share, one place and one point of the sun
/// tell by a ray. Where light has bounced, the share is even: there nobody sees shafts.
Rgb Shader::light_of_haze(const Path& path, double length, SampleStream& random) {
    const Haze& haze = *view_.haze;
    if (!haze_sun_ || path.bounces > 0) return haze.rgb;
    const Lamp sun = part_of(*haze_sun_, random);
    const Vec3 place =
        path.ray(haze.length_of_share(path.ray.origin, path.ray.direction, length, random.next().x));
    const double scattered = haze.sun * Haze::scattered(path.ray.direction, sun.at);
    const Rgb seen =
        sun.shadowless ? Rgb(1.0)
                       : light_through({place, sun.at}, {least_distance(place, shadow_pixels)}, path.inside);
    return (1 - haze.sun + scattered * seen) * haze.rgb;
}

/// The way on from a surface, backwards along the light: its refracted ray, while the mirrored one waits.
/// Where light may bounce, or has, it is one of them or one by the cosine. Each has the chance of its share
/// of the light of the three. False at the end. `scattered`: how much is by the cosine; `sky_later`: with
/// the sky's light.
bool Shader::goes_on(Path& path, const Point& point, double scattered, bool sky_later, SampleStream& random) {
    const double along = glm::dot(point.to_viewer, point.facet);
    const Material& material = *point.material;
    Way mirror{point.mirrored, point.mirrors, 2 * along * point.facet - point.to_viewer};
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
            pane.direction = (ratio * along - std::sqrt(square)) * point.facet - ratio * point.to_viewer;
        }
    }
    if (point.blur > 0) {
        mirror.roughen(point.normal, point.blur);
        pane.roughen(-point.normal, point.blur);
    }
    if (scattered > 0 || (path.bounces > 0 && mirror.counts > 0 && pane.counts > 0)) {
        const glm::dvec2 choice = random.next();
        const double all = mirror.counts + pane.counts + scattered;
        // The weight tells how much of the path's light there is left to look for.
        const double going_on = sky_later ? 1 : std::min(1.0, all);
        if (choice.x >= going_on) return false;
        const double mirror_chance = going_on * mirror.counts / all;
        const double pane_chance = going_on * pane.counts / all;
        const double scatter_chance = scattered > 0 ? going_on - mirror_chance - pane_chance : 0;
        if (choice.x < scatter_chance) {
            path.counts *= scattered / scatter_chance;
            path.weight /= scatter_chance;
            path.takes_sky = sky_later;
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

double Shader::scattered_by(const Point& point) {
    return point.shone_on * point.body * (point.material->diffuse + point.material->translucency) *
           formulas::lit_from_all_sides(point.facing) * largest(point.rgb);
}

/// Scatters a path by the cosine, to either side. `choice`: of the side, in [0, 1).
bool Shader::scatter(Path& path, const Point& point, double choice, SampleStream& random) const {
    const double through = point.material->translucency, diffuse = point.material->diffuse + through;
    path.weight *=
        point.shone_on * point.body * diffuse * formulas::lit_from_all_sides(point.facing) * point.rgb;
    const bool passes = choice * diffuse < through;
    path.ray = {passes ? point.far_side : point.position,
                formulas::cosine_direction(passes ? -point.normal : point.normal, random.next())};
    ++path.bounces;
    return is_finite(path.ray.direction);
}

bool Shader::first_hit(const Ray& ray, SurfaceHit& hit) {
    return closest(ray, {}, hit);
}

bool Shader::first_hit(const Ray& ray, SurfaceHit& hit, const Ahead& ahead, std::size_t number) {
    const Known found = known(ahead, number);
    return closest(ray, {}, hit, &found);
}

bool Shader::closest(const Ray& ray, RayRange range, SurfaceHit& hit, const Known* known) {
    range.most = std::min(range.most, limits_.farthest);
    if (known && known->hit) hit = *known->hit;
    const bool found = known ? known->hit != nullptr : surfaces_.closest(ray, range, hit);
    if (!view_.ground) return found;
    if (found) range.most = hit.t;
    double t = 0;
    if (!meet_ground(ray, range, t)) return found;
    hit = {t, {0, 1, 0}, view_.ground->material.rgb, &view_.ground->material};
    if (view_.ground->material.pattern) {
        const Material& material = view_.ground->material;
        const Vec3 place = ray(t);
        // A pixel that looks along the ground sees a long, narrow piece of it: a square of its area counts.
        const double footprint =
            least_distance(place, 1) / std::sqrt(std::max(std::abs(ray.direction.y), 1e-3));
        const PatternValue at = pattern_at(material.pattern, 1, footprint, place);
        work_ += RayWork::pattern_wave * material.pattern.waves();
        hit.rgb = pattern_colour(material.pattern, material.rgb, at.value);
        show_relief(at, material.pattern.bump, ray.direction, hit);
    }
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

Shader::Point Shader::point_of(const Ray& ray, const Inside& inside, const SurfaceHit& hit,
                               SampleStream& random) const {
    Vec3 normal = hit.normal;
    if (glm::dot(hit.normal, ray.direction) > 0) normal = -hit.normal;
    const Material& material = *hit.material;
    Point point{.position = ray(hit.t),
                .normal = normal,
                .facet = normal,
                .to_viewer = -ray.direction,
                .rgb = hit.rgb,
                .material = &material,
                .specular = material.specular,
                .roughness = std::max(material.roughness, least_roughness),
                .blur = material.blur,
                .inside = &inside};
    if (hit.faded > 0)
        formulas::roughen_by_relief(hit.faded, point.facing, point.specular, point.roughness, point.blur);
    if (limits_.list || !(material.reflection > 0 || material.is_transparent())) point.blur = 0;
    if (point.blur > 0)
        point.facet = formulas::visible_facet(normal, point.to_viewer, point.blur, random.next());
    // Exactly on the ground, its own shadow cannot begin on the way to a low sun.
    if (view_.ground && hit.material == &view_.ground->material) point.position.y = view_.ground->height;
    if (hit.material == &catcher_paper_) point.position.y = view_.catcher->centre.y;
    point.shone_on = hit.light_share;
    point.far_side = point.position + hit.to_far_side;
    share_light(point);
    return point;
}

void Shader::share_light(Point& point) const {
    const Material& material = *point.material;
    const double cosine = std::min(1.0, glm::dot(point.to_viewer, point.facet));
    point.mirrors = material.reflection;
    if (material.has_coat()) {
        if (point.mirrors > 0)
            point.mirrors *= formulas::fresnel(point.inside->relative_ior(interior_of(material)), cosine);
        // POV-Ray leaves out what lies below a coat that is all but a mirror.
        point.body = 1 - point.mirrors > limits_.least_weight ? 1 - point.mirrors : 0;
    }
    point.mirrored = Rgb(point.mirrors);
    if (point.mirrors > 0 && material.metallic > 0)
        point.mirrored *= formulas::metal_colour(material.metallic, point.rgb, cosine);
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

Rgb Shader::sky(Vec3 direction) const {
    if (view_.shows_sky_light) return view_.sky_light->radiance(direction);
    const Sky& sky = view_.sky;
    if (sky.zenith == sky.horizon) return sky.zenith;
    const double height = (glm::dot(direction, sky.axis) - sky.from) * sky_slope_;
    const double t = height > 0 ? std::min(height, most_zenith) : 0;
    return (1 - t) * sky.horizon + t * sky.zenith;
}

} // namespace graftal
