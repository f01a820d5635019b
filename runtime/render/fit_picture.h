#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "runtime/render/fit_work.h"
#include "runtime/render/render.h"

namespace graftal {

struct PreparedView;

/// Where POV-Ray's pictures end, and whether soft light is listed.
ShaderLimits limits_of(const PreparedCut& prepared, const View& view, const RenderOptions& options);

/// The native engine's plan for a view: the detail, with the work that goes for this light, and the wanted
/// samples.
struct PicturePlan {
    bool sampled = false; ///< pixels are estimated, by samples that differ
    DetailOptions detail;
    Sampling wanted;
};
PicturePlan plan_picture(const PreparedView& prepared, const RenderOptions& options);

/// Fits the model and the samples to the work (fit_work.h).
FittedModel fit_picture(const PreparedView& prepared, const RenderOptions& options, const PicturePlan& plan,
                        const std::function<bool()>& cancelled,
                        const std::function<void(const TraceModel&, double)>& on_first_look = {});

/// The values of a fitted model that model_of() needs to make it again, without a ray.
PictureFit fit_of(const FittedModel& fitted, ImageSize size);

/// The model that was fitted, made from the options of the same picture.
std::unique_ptr<TraceModel> model_of(const PictureFit& fit, const PreparedView& prepared,
                                     const DetailOptions& detail);

} // namespace graftal
