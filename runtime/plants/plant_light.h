#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compiler/support/control.h"
#include "compiler/support/workers.h"
#include "runtime/plants/plant_sky.h"
#include "runtime/trace/model/trace_model.h"

namespace graftal {

struct Plant;

struct PlantLightOptions {
    /// The samples of an organ; nothing: usual_samples, and more until the standard errors of the organs'
    /// light are, in their root mean square, enough_error of its mean.
    std::optional<int> samples;
    double work_seconds = 10; ///< of one processor, counted (detail/work.h)

    static constexpr int usual_samples = 64, most_samples = 65'536;
    static constexpr double enough_error = 0.01;
};

/// Light on an organ, where an open horizontal plane has 1. Of flat organs both sides count together, for an
/// area of one side; of others it is the mean over the surface. No numbers where nothing is known.
struct OrganLight {
    float light;    ///< irradiance, with what other organs scatter
    float error;    ///< its standard error, as its samples show it: it lacks what is so rare that none met it
    float absorbed; ///< the part of it that the organ takes
    float sunlit;   ///< share of the surface that the brightest sun shines on; no number without a sun
};

/// An amount of light, in units of what falls on a unit of open ground; and its standard error, likewise.
struct LightAmount {
    double amount = 0, error = 0;
};

/// The light that a plant takes.
struct PlantLight {
    std::vector<OrganLight> organs; ///< by module; one that is drawn as others has their mean
    LightAmount falls;              ///< on the plant before it meets anything else
    LightAmount absorbed;           ///< sum over organs
    LightAmount absorbed_by_leaves; ///< by blades
    // Ends of the light that falls, followed from organ to organ, by chance; together they are `falls`:
    double taken = 0, to_sky = 0, to_ground = 0, left = 0;
    double sunlit_leaf_area = 0, shaded_leaf_area = 0;
    bool has_sun = false;
    std::uint64_t lit_organs = 0;
    int samples = 0; ///< of each organ
    std::uint64_t rays = 0;
    std::uint64_t given_up = 0; ///< rays that met too many parts
    double work_seconds = 0;
};

/// The light on each organ of a plant that the model shows. It takes 4 samples of each organ, then twice as
/// many, and so on, as far as the options ask for them and the work suffices. The result is the same for any
/// number of threads. Nothing, with a `problem`, where not even 4 fit the work, or no light comes from above.
/// Throws Cancelled.
std::optional<PlantLight> light_on_plant(const Plant& plant, const TraceModel& model, const PlantSky& sky,
                                         const PlantLightOptions& options, const Workers& workers,
                                         const Control& control, std::string& problem);

} // namespace graftal
