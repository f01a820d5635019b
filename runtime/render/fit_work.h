#pragma once

#include <functional>
#include <memory>

#include "runtime/trace/shade.h"
#include "runtime/trace/trace_model.h"

namespace graftal {

/// A model that can be traced within the work allowed, and what that took.
struct FittedModel {
    std::unique_ptr<TraceModel> model;
    /// Of one processor that what the rays meet will take, about (detail/work.h); samples that meet nothing
    /// take more.
    double seconds = 0;
    double allowed_seconds = 0; ///< what trying has left of the work; the picture may take more even so
    double whole_seconds = 0;   ///< that it would have taken as it was asked for
    double tried_seconds = 0;   ///< that trying took of them
    double error_px = 0;        ///< of what is culled now
    bool work_cut = false;      ///< more is culled than asked for, or rays are cut, for the work
    bool samples_cut = false;   ///< only some of the samples can be had
    bool rays_cut = false;      ///< each ray goes into fewer parts than it wants, too
    bool out_of_memory = false; ///< it was not for the work alone
};

/// Tries rays over the whole picture, one for some pixels, and predicts what all of them take:
/// `samples_a_pixel` in the end. Where that is more than the view's work_seconds, first what is culled grows
/// by most_before_samples, then samples go, down to `fewest_a_pixel`, then what is culled grows on, and at
/// last rays are given up sooner. The seconds are those of all samples. What is culled grows also where a
/// model takes more memory than there is
/// (`out_of_memory`); if none fits, std::bad_alloc is thrown. Nothing but
/// counts decides, so the result is the same whatever the machine and its threads. `cancelled` is asked
/// often; once it says true, any model comes back. `on_first_look`, if it is set, is called once, after the
/// first few rays: with a model, and the seconds that a picture of it seems to take. Nothing that it does
/// with the model changes the result, unless it has shells made.
FittedModel fit_work(std::shared_ptr<const PreparedCut> prepared, const View& view,
                     const DetailOptions& options, const ModelTextures& textures, double samples_a_pixel,
                     double fewest_a_pixel, const std::function<ShaderLimits(const TraceModel&)>& limits_of,
                     int threads, const std::function<bool()>& cancelled,
                     const std::function<void(const TraceModel&, double)>& on_first_look = {});

/// By so much parts that are left out may grow before samples go: a ragged edge is seen sooner than a part of
/// a pixel's width, and later than one of two.
inline constexpr double most_before_samples = 2.3;

} // namespace graftal
