#include "runtime/plants/plant_light.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include <fmt/format.h>

#include "compiler/detail/coarser.h"
#include "compiler/detail/work.h"
#include "compiler/lower/plant.h"
#include "runtime/plants/plant_rays.h"
#include "runtime/plants/plant_tree.h"

namespace graftal {

namespace {

constexpr float unknown_light = std::numeric_limits<float>::quiet_NaN();
constexpr int first_samples = 4;
constexpr std::uint64_t organs_a_task = 64, tasks_a_block = 64;
/// Organs that are looked at once to tell what all of them take.
constexpr std::uint64_t tried_organs = 256;

/// An organ that light may fall on.
struct LitOrgan {
    std::uint32_t module = 0;
    std::uint32_t blade = PlantModule::none;
};

/// Sums over the samples of an organ.
struct OrganSums {
    double light = 0, light_squares = 0, direct = 0, direct_squares = 0, absorbed = 0, absorbed_squares = 0;
    double taken = 0, to_sky = 0, to_ground = 0, left = 0, sunlit = 0;
    double area = 0;

    void add(const OrganSample& sample) {
        light += sample.light;
        light_squares += sample.light * sample.light;
        direct += sample.direct;
        direct_squares += sample.direct * sample.direct;
        absorbed += sample.absorbed;
        absorbed_squares += sample.absorbed * sample.absorbed;
        taken += sample.taken;
        to_sky += sample.to_sky;
        to_ground += sample.to_ground;
        left += sample.left;
        sunlit += sample.sunlit ? 1 : 0;
    }
};

/// The standard error of a mean of `count` independent numbers. Those of a sequence that spreads evenly have
/// less.
double error_of(double sum, double squares, int count) {
    const double mean = sum / count;
    return std::sqrt(std::max(squares / count - mean * mean, 0.0) / (count - 1));
}

class PlantLighting {
  public:
    PlantLighting(const Plant& plant, const TraceModel& model, const PlantSky& sky,
                  const PlantLightOptions& options, const Workers& workers, const Control& control)
        : plant_(plant), model_(model), sky_(sky), options_(options), workers_(workers), control_(control),
          rays_(static_cast<std::size_t>(workers.count())) {}

    std::optional<PlantLight> run(std::string& problem) {
        find_organs();
        const std::uint64_t count = organs_.size();
        sums_.assign(count, {});
        const double tried = try_some();
        const double expected = first_samples * tried * static_cast<double>(count);
        if (expected > options_.work_seconds) {
            problem = fmt::format("the light on {} organs takes at least {} seconds of work", count,
                                  readable_seconds(expected));
            return std::nullopt;
        }
        const int most = options_.samples.value_or(PlantLightOptions::most_samples);
        int samples = 0;
        for (int more = first_samples; samples < most && count > 0 && !is_enough(samples);
             more = std::min(samples, most - samples)) {
            if (samples > 0 &&
                work_seconds() * (1 + static_cast<double>(more) / samples) > options_.work_seconds)
                break;
            sample_all(samples, samples + more);
            samples += more;
        }
        return result(samples);
    }

  private:
    void find_organs() {
        std::size_t next_blade = 0;
        for (std::uint32_t i = 0; i < plant_.modules.size(); ++i) {
            LitOrgan organ{i};
            while (next_blade < plant_.blades.size() && plant_.blades[next_blade].module < i)
                ++next_blade;
            if (next_blade < plant_.blades.size() && plant_.blades[next_blade].module == i)
                organ.blade = static_cast<std::uint32_t>(next_blade);
            if (plant_.modules[i].organ != Organ::none && surface_of(organ).area() > 0)
                organs_.push_back(organ);
        }
    }

    OrganSurface surface_of(const LitOrgan& organ) const {
        return OrganSurface(plant_, organ.module,
                            organ.blade == PlantModule::none ? nullptr : &plant_.blades[organ.blade]);
    }

    PlantRays& rays_of(int worker) {
        std::unique_ptr<PlantRays>& rays = rays_[static_cast<std::size_t>(worker)];
        if (!rays) rays = std::make_unique<PlantRays>(model_, sky_);
        return *rays;
    }

    /// Seconds of work for one sample of an organ, by some organs all over the plant.
    double try_some() {
        const std::uint64_t count = organs_.size(), tried = std::min(count, tried_organs);
        if (tried == 0) return 0;
        PlantRays rays(model_, sky_);
        for (std::uint64_t i = 0; i < tried; ++i) {
            const LitOrgan& organ = organs_[i * count / tried];
            rays.sample(surface_of(organ), organ.module, 0);
        }
        return static_cast<double>(rays.work()) / WorkRates::ray_steps / static_cast<double>(tried);
    }

    /// Whether so many samples of each organ are as exact as is asked for.
    bool is_enough(int samples) const {
        if (options_.samples || samples < PlantLightOptions::usual_samples) return false;
        double light = 0, errors = 0;
        for (const OrganSums& sums : sums_) {
            light += sums.light / samples;
            errors += std::pow(error_of(sums.light, sums.light_squares, samples), 2);
        }
        const auto count = static_cast<double>(sums_.size());
        return std::sqrt(errors / count) <= PlantLightOptions::enough_error * light / count;
    }

    void sample_all(int begin, int end) {
        const std::uint64_t tasks = (organs_.size() + organs_a_task - 1) / organs_a_task;
        for (std::uint64_t first = 0; first < tasks; first += tasks_a_block) {
            workers_.for_each(std::min(tasks_a_block, tasks - first), [&](int worker, std::uint64_t number) {
                sample_task(rays_of(worker), first + number, begin, end);
            });
            if (control_.cancel.raised()) throw Cancelled();
            if (control_.on_progress) control_.on_progress({"light", first, tasks});
        }
    }

    void sample_task(PlantRays& rays, std::uint64_t task, int begin, int end) {
        const std::uint64_t last = std::min<std::uint64_t>((task + 1) * organs_a_task, organs_.size());
        for (std::uint64_t i = task * organs_a_task; i < last; ++i) {
            if (control_.cancel.raised()) return;
            const OrganSurface surface = surface_of(organs_[i]);
            sums_[i].area = surface.area();
            for (int sample = begin; sample < end; ++sample)
                sums_[i].add(rays.sample(surface, organs_[i].module, static_cast<std::uint32_t>(sample)));
        }
    }

    double work_seconds() const {
        std::uint64_t work = 0;
        for (const auto& rays : rays_)
            if (rays) work += rays->work();
        return static_cast<double>(work) / WorkRates::ray_steps;
    }

    PlantLight result(int samples) {
        PlantLight light;
        light.organs.assign(plant_.modules.size(),
                            {unknown_light, unknown_light, unknown_light, unknown_light});
        light.has_sun = !sky_.suns.empty();
        light.samples = samples;
        light.lit_organs = organs_.size();
        light.work_seconds = work_seconds();
        for (const auto& rays : rays_)
            if (rays) {
                light.rays += rays->rays();
                light.given_up += rays->given_up();
            }
        double falls = 0, absorbed = 0, by_leaves = 0; // squares of errors
        for (std::size_t i = 0; i < organs_.size(); ++i) {
            const OrganSums& sums = sums_[i];
            const double share = sums.area / samples;
            const double error = error_of(sums.absorbed, sums.absorbed_squares, samples) * sums.area;
            const double direct_error = error_of(sums.direct, sums.direct_squares, samples) * sums.area;
            light.falls.amount += share * sums.direct;
            falls += direct_error * direct_error;
            light.absorbed.amount += share * sums.absorbed;
            absorbed += error * error;
            light.taken += share * sums.taken;
            light.to_sky += share * sums.to_sky;
            light.to_ground += share * sums.to_ground;
            light.left += share * sums.left;
            if (is_blade(plant_.modules[organs_[i].module])) {
                light.absorbed_by_leaves.amount += share * sums.absorbed;
                by_leaves += error * error;
                light.sunlit_leaf_area += share * sums.sunlit;
                light.shaded_leaf_area += share * (samples - sums.sunlit);
            }
            light.organs[organs_[i].module] = {
                static_cast<float>(sums.light / samples),
                static_cast<float>(error_of(sums.light, sums.light_squares, samples)),
                static_cast<float>(sums.absorbed / samples),
                light.has_sun ? static_cast<float>(sums.sunlit / samples) : unknown_light};
        }
        light.falls.error = std::sqrt(falls);
        light.absorbed.error = std::sqrt(absorbed);
        light.absorbed_by_leaves.error = std::sqrt(by_leaves);
        fill_wholes(light);
        return light;
    }

    /// Modules that are drawn as others get the mean of their parts, by their areas.
    void fill_wholes(PlantLight& light) const {
        struct Sums {
            double area = 0, light = 0, variance = 0, absorbed = 0, sunlit = 0;
        };
        Sums sums;
        std::uint32_t whole = PlantModule::none;
        const auto give = [&] {
            if (whole != PlantModule::none && sums.area > 0)
                light.organs[whole] = {static_cast<float>(sums.light / sums.area),
                                       static_cast<float>(std::sqrt(sums.variance) / sums.area),
                                       static_cast<float>(sums.absorbed / sums.area),
                                       static_cast<float>(sums.sunlit / sums.area)};
            sums = {};
        };
        for (std::size_t i = 0; i < organs_.size(); ++i) { // parts of one follow each other
            const std::uint32_t of = plant_.modules[organs_[i].module].part_of;
            if (of != whole) give();
            whole = of;
            if (of == PlantModule::none) continue;
            const OrganLight& part = light.organs[organs_[i].module];
            const double area = sums_[i].area;
            sums.area += area;
            sums.light += area * static_cast<double>(part.light);
            sums.variance += std::pow(area * static_cast<double>(part.error), 2);
            sums.absorbed += area * static_cast<double>(part.absorbed);
            sums.sunlit += area * static_cast<double>(part.sunlit);
        }
        give();
    }

    const Plant& plant_;
    const TraceModel& model_;
    const PlantSky& sky_;
    const PlantLightOptions& options_;
    const Workers& workers_;
    const Control& control_;
    std::vector<std::unique_ptr<PlantRays>> rays_; ///< by thread
    std::vector<LitOrgan> organs_;
    std::vector<OrganSums> sums_;
};

} // namespace

std::optional<PlantLight> light_on_plant(const Plant& plant, const TraceModel& model, const PlantSky& sky,
                                         const PlantLightOptions& options, const Workers& workers,
                                         const Control& control, std::string& problem) {
    const Rgb open = sky.open();
    if (!(open.r + open.g + open.b > 0)) {
        problem = "no sky of the model shines from above, and no sun that casts shadows";
        return std::nullopt;
    }
    return PlantLighting(plant, model, sky, options, workers, control).run(problem);
}

} // namespace graftal
