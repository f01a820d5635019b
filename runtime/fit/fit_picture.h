#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "compiler/session/values.h"
#include "runtime/fit/fit_work.h"

namespace graftal {

/// The fineness that is asked of a picture, and the work that may go into it.
struct PictureWishes {
    std::optional<int> antialias = 2;   ///< up to 4^(N-1) samples a pixel; nothing: one
    std::optional<int> samples;         ///< of soft light, the most a pixel; nothing: by the quality
    std::optional<double> noise_255;    ///< largest error left; nothing: by the quality
    std::optional<bool> denoise;        ///< soft light; nothing: by the quality
    std::optional<double> work_seconds; ///< of one processor; nothing: by the quality
    bool listed_lights = false;         ///< soft light from a list of lights (light_list.h)

    /// Seconds of one processor that a picture may take: on two processors a picture of normal quality is
    /// there within ten seconds, whatever comes before it.
    double work(Quality quality) const { return work_seconds.value_or(by_quality(quality, 5.0, 9.0, 600.0)); }
};

/// The culling of a model and the rays of its picture, so that its work is within limits (fit_work.h). To
/// find the fit takes rays all over the picture. A program that draws parts of it finds the fit once.
struct PictureFit {
    ImageSize size; ///< of the whole picture
    double error_px = 0;
    std::optional<double> error_world;
    std::uint64_t most_visits = 0; ///< TraceModel::most_visits
    Sampling sampling;
    double seconds = 0; ///< of one processor that the whole picture will take, about

    bool operator==(const PictureFit&) const = default;
};

/// The model that rays go through: the detail is resolved() for the view, and the graph prepared for both.
struct PreparedView {
    std::shared_ptr<const ViewedModel> viewed;
    DetailOptions detail;
    std::shared_ptr<const PreparedGraph> prepared;
    ModelTextures textures;
};

/// Where POV-Ray's pictures end, and whether soft light is listed.
ShaderLimits limits_of(const PreparedGraph& prepared, const View& view, const PictureWishes& wishes);

/// The native engine's plan for a view: the detail, with the work that goes for this light, and the wanted
/// samples.
struct PicturePlan {
    bool sampled = false; ///< pixels are estimated, by samples that differ
    DetailOptions detail;
    Sampling wanted;
};
PicturePlan plan_picture(const PreparedView& prepared, const PictureWishes& wishes);

/// Fits the model and the samples to the work, as fit_work() does. The last four are those of FitRequest.
std::optional<FittedModel>
fit_picture(const PreparedView& prepared, const PictureWishes& wishes, const PicturePlan& plan,
            const Workers& workers, const std::function<bool()>& cancelled,
            const std::function<void(const TraceModel&, double)>& on_first_look = {},
            std::shared_ptr<TraceBasis> basis = nullptr);

/// The values of a fitted model that model_of() needs to make it again, without a ray.
PictureFit fit_of(const FittedModel& fitted, ImageSize size);

/// The model that was fitted, made from the options of the same picture.
std::unique_ptr<TraceModel> model_of(const PictureFit& fit, const PreparedView& prepared,
                                     const DetailOptions& detail);

} // namespace graftal
