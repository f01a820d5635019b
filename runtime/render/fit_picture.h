#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "runtime/render/fit_work.h"
#include "runtime/render/render.h"

namespace graftal {

struct PreparedView;

/// Of the work, what may go to samples that meet nothing: what is seen takes the rest.
inline constexpr double most_for_samples = 0.5;

/// How closely a picture is looked at.
struct Looks {
    std::vector<Sampling> wanted;
    std::vector<Sampling> tried;      ///< for which the model was fitted
    std::vector<Sampling> affordable; ///< with that model

    bool fewer() const { return samples_a_pixel(affordable) < samples_a_pixel(wanted); }
};

/// Where POV-Ray's pictures end, and whether soft light is listed.
ShaderLimits limits_of(const TraceModel& model, const RenderOptions& options);

/// How the native engine will draw a view: the detail with the work that goes for this light, and the looks
/// that are wanted, and tried while the model is fitted.
struct PicturePlan {
    bool sampled = false; ///< pixels are estimated, by samples that differ
    DetailOptions detail;
    Looks looks;
};
PicturePlan plan_picture(const PreparedView& prepared, const RenderOptions& options);

/// Fits the model to the work (fit_work.h), and settles plan.looks.affordable.
FittedModel fit_picture(const PreparedView& prepared, const RenderOptions& options,
                        const std::function<bool()>& cancelled,
                        const std::function<void(const TraceModel&, double)>& on_first_look,
                        PicturePlan& plan);

/// What a fitted model needs in order to be made again, without a ray.
PictureFit fit_of(const FittedModel& fitted, const PicturePlan& plan, ImageSize size);

/// The model that was fitted, made from the options of the same picture.
std::unique_ptr<TraceModel> model_of(const PictureFit& fit, const PreparedView& prepared,
                                     const DetailOptions& detail);

} // namespace graftal
