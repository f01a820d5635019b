#include "compiler/detail/self_shadow.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include <glm/geometric.hpp>

#include "compiler/detail/part_rays.h"
#include "compiler/detail/prepare.h"
#include "compiler/detail/work.h"
#include "compiler/scene/light_list.h"

namespace graftal {

namespace {

constexpr std::uint64_t most_rays = 1 << 15;
constexpr double enough_hits = 8000;
/// Lights in the list for each kind; each hit tries a few.
constexpr LightListSize lights_of_areas{4, 48, 4};
constexpr std::size_t lights_a_hit = 3;
/// Rays of an object by which it is believed as much as all objects together.
constexpr double rays_of_doubt = 64;
/// Sizes are told apart by quarters of an octave.
constexpr std::size_t bins = 64;
/// A level takes half of the light at most. It may also give some: solids keep off light that leaves let
/// through.
constexpr double darkest_log = -1, brightest_log = 0.5;

double brightness(Rgb rgb) {
    return (rgb.r + rgb.g + rgb.b) / 3;
}

/// Hits and light of rays on the parts of an object.
struct Seen {
    double culled_hits = 0, whole_hits = 0;
    double whole_light = 0;
    std::array<double, bins> culled_light{}; ///< by size

    Seen& operator+=(const Seen& other) {
        culled_hits += other.culled_hits;
        whole_hits += other.whole_hits;
        whole_light += other.whole_light;
        for (std::size_t i = 0; i < bins; ++i)
            culled_light[i] += other.culled_light[i];
        return *this;
    }

    double hits() const { return std::min(culled_hits, whole_hits); }

    /// Light where parts are culled, with these shares.
    double light_with(double octave_log) const {
        double sum = 0;
        for (std::size_t i = 0; i < bins; ++i)
            sum += culled_light[i] * std::exp2(octave_log * (static_cast<double>(i) + 0.5) / 4);
        return sum / culled_hits;
    }

    /// The logarithm with which both are as bright in the mean; 0 where there is nothing to compare.
    double octave_log() const {
        if (!(hits() > 0) || !(light_with(0) > 0)) return 0;
        const double light = whole_light / whole_hits;
        double low = darkest_log, high = brightest_log;
        for (int step = 0; step < 24; ++step) {
            const double middle = 0.5 * (low + high);
            (light_with(middle) < light ? low : high) = middle;
        }
        return 0.5 * (low + high);
    }
};

/// Where a ray has met a part.
struct LitPoint {
    Vec3 point, normal; ///< the normal towards the viewer
    Rgb rgb;
    const Material& material;

    /// Scattered part of light from there: it falls on the viewer's side, or comes through from the other.
    double scattered(Rgb light, Vec3 direction) const {
        const double cosine = glm::dot(normal, direction);
        return brightness(rgb * light) * (cosine > 0 ? material.diffuse : -material.translucency) * cosine;
    }
};

class Measurer {
  public:
    Measurer(const DetailGraph& cut, const Symmetry& symmetry, std::uint32_t root_steps, const View& view,
             bool limit_normals, std::uint64_t most_work)
        : most_work_(most_work), cut_(cut), view_(view),
          culled_projection_(projection(self_shadow_measured_px)),
          whole_projection_(projection(SelfShadows::lit_as_px)),
          culled_(cut, culled_projection_, root_steps, self_shadow_measured_px, limit_normals),
          whole_(cut, whole_projection_, root_steps, self_shadow_measured_px, limit_normals),
          shape_of_(symmetry.representative) {
        for (const Light& light : listed_lights(view, lights_of_areas)) {
            if (!(brightness(light.rgb) > 0)) continue;
            (light.shadowless ? bare_ : lights_).push_back(light);
            if (light.shadowless) continue;
            total_ += brightness(light.rgb);
            up_to_.push_back(total_);
        }
    }

    SelfShadows run(int steps, const CancelFlag& cancel) {
        if (lights_.empty()) return {};
        // The R2 sequence covers the picture evenly at any length.
        const double g = 1.32471795724474602596;
        double hits = 0;
        for (std::uint64_t i = 0; i < most_rays && hits < enough_hits; ++i) {
            if (culled_.work() + whole_.work() > most_work_) break;
            if (cancel.raised()) throw Cancelled();
            const auto n = static_cast<double>(i);
            const auto part = [&](double slope) { return std::fmod(0.5 + n * slope, 1.0); };
            const Ray ray = camera_ray(part(1 / g), part(1 / (g * g)));
            const double light_choice = part(std::numbers::phi - 1);
            hits += look(ray, light_choice) ? 1 : 0;
        }
        Seen all;
        for (const auto& [node, seen] : seen_)
            all += seen;
        const double mean = all.octave_log();
        std::vector<float> logs(cut_.nodes.size(), static_cast<float>(mean));
        for (const auto& [shape, seen] : seen_) {
            const double own = seen.hits() / (seen.hits() + rays_of_doubt);
            logs[shape] = static_cast<float>(own * seen.octave_log() + (1 - own) * mean);
        }
        for (NodeId id = 0; id < logs.size(); ++id)
            logs[id] = logs[shape_of_[id]];
        return {std::move(logs), steps, culled_.work() + whole_.work()};
    }

  private:
    Projection projection(double error_px) const {
        DetailOptions options;
        options.error_px = error_px;
        return {view_, options, error_px, nearest_to_eye(cut_)};
    }

    Ray camera_ray(double x, double y) const {
        const Camera& camera = view_.camera;
        const double half_width =
            camera.orthographic ? 0.5 * camera.width : std::tan(camera.angle_deg * std::numbers::pi / 360);
        const double half_height = half_width * view_.size.height / view_.size.width;
        const Vec3 across = half_width * (2 * x - 1) * camera.right + half_height * (1 - 2 * y) * camera.up;
        if (camera.orthographic) return {camera.location + across, camera.direction};
        return {camera.location, glm::normalize(camera.direction + across)};
    }

    /// False where neither way anything is met that may be culled.
    bool look(const Ray& ray, double light_choice) {
        PartHit culled, whole;
        const bool meets_culled = culled_.closest(ray, 0, culled) && culled.part != PartHit::none;
        const bool meets_whole = whole_.closest(ray, 0, whole) && whole.part != PartHit::none;
        if (meets_culled) {
            Seen& seen = seen_[shape_of_[culled.part]];
            const double octaves = std::log2(culled.part_px / SelfShadows::lit_as_px);
            const double bin = std::clamp(4 * octaves, 0.0, bins - 1.0);
            seen.culled_light[static_cast<std::size_t>(bin)] += light(culled_, ray, culled, light_choice);
            ++seen.culled_hits;
        }
        if (meets_whole) {
            Seen& seen = seen_[shape_of_[whole.part]];
            seen.whole_light += light(whole_, ray, whole, light_choice);
            ++seen.whole_hits;
        }
        return meets_culled || meets_whole;
    }

    /// Light that the surface scatters to the viewer, of all that reaches either side of it.
    double light(PartRays& rays, const Ray& ray, const PartHit& hit, double choice) {
        const LitPoint lit{ray(hit.t), glm::dot(hit.normal, ray.direction) > 0 ? -hit.normal : hit.normal,
                           hit.rgb, hit.material ? cut_.materials[*hit.material] : plain_};
        double sum = 0;
        for (const Light& light : bare_)
            sum += lit.scattered(light.rgb, towards(light, lit.point));
        const std::size_t tries = std::min(lights_a_hit, lights_.size());
        for (std::size_t i = 0; i < tries; ++i) {
            const double at = total_ * (static_cast<double>(i) + choice) / static_cast<double>(tries);
            const auto number = std::min<std::size_t>(
                static_cast<std::size_t>(std::ranges::upper_bound(up_to_, at) - up_to_.begin()),
                lights_.size() - 1);
            const Light& light = lights_[number];
            sum += total_ / static_cast<double>(tries) / brightness(light.rgb) * shadowed(rays, light, lit);
        }
        return sum;
    }

    static Vec3 towards(const Light& light, Vec3 point) {
        return glm::normalize(light.sun ? light.location : light.location - point);
    }

    /// Scattered part of a light, if nothing hides it.
    double shadowed(PartRays& rays, const Light& light, const LitPoint& lit) const {
        const Vec3 point = lit.point, direction = towards(light, point);
        const double scattered = lit.scattered(light.rgb, direction);
        if (!(scattered > 0)) return 0;
        constexpr double least_px = 1e-3; // the tracer's shadow_pixels
        RayRange range{least_px / whole_projection_.pixels_per_unit({point, 0})};
        if (!light.sun) range.most = glm::length(light.location - point);
        return rays.meets_any({point, direction}, range) ? 0 : scattered;
    }

    const std::uint64_t most_work_;
    const DetailGraph& cut_;
    const View& view_;
    const Material plain_; ///< of parts that name none
    Projection culled_projection_, whole_projection_;
    PartRays culled_, whole_;
    std::vector<Light> lights_, bare_;
    std::vector<double> up_to_; ///< brightness of the lights, added up
    double total_ = 0;
    const std::vector<NodeId>& shape_of_; ///< by node: mirror images share a mesh, and so a share
    std::map<NodeId, Seen> seen_;         ///< by shape
};

} // namespace

double SelfShadows::share(NodeId node, double size_px) const {
    if (octave_logs_.empty() || !(size_px > lit_as_px)) return 1;
    const double exact = std::exp2(static_cast<double>(octave_logs_[node]) * std::log2(size_px / lit_as_px));
    return std::max(1.0, std::round(steps_ * exact)) / steps_; // a share of 0 would be black
}

double SelfShadows::share_within(double outer, NodeId node, double detail, double error_px) const {
    if (outer != 1 || !(detail <= 1)) return outer;
    return share(node, detail * error_px);
}

SelfShadows measure_self_shadows(const DetailGraph& cut, const Symmetry& symmetry, std::uint32_t root_steps,
                                 const View& view, bool limit_normals, int steps, std::uint64_t most_work,
                                 const CancelFlag& cancel) {
    return Measurer(cut, symmetry, root_steps, view, limit_normals, most_work).run(steps, cancel);
}

std::uint64_t self_shadow_work(double work_seconds) {
    constexpr double share = 0.1;
    return static_cast<std::uint64_t>(std::min(share * work_seconds * WorkRates::parts_gone_by,
                                               static_cast<double>(most_self_shadow_work)));
}

} // namespace graftal
