#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "compiler/support/workers.h"
#include "runtime/fit/samplings.h"
#include "runtime/trace/model/trace_model.h"
#include "runtime/trace/shade/shade.h"

namespace graftal {

/// A model that can be traced within the work allowed, and what that took.
struct FittedModel {
    std::unique_ptr<TraceModel> model;
    Sampling sampling;          ///< for which the work suffices; at most the one that is wanted
    double seconds = 0;         ///< of one processor that the picture will take, about (detail/work.h)
    double whole_seconds = 0;   ///< of the picture as it was asked for
    double sample_seconds = 0;  ///< of one sample for each pixel
    double tried_seconds = 0;   ///< of the work, for trying
    double error_px = 0;        ///< of the parts that are culled now
    bool rays_cut = false;      ///< each ray goes into fewer parts than it wants
    bool out_of_memory = false; ///< the error is not for the work alone
};

/// A picture that a model is fitted for.
struct FitRequest {
    std::shared_ptr<const PreparedGraph> prepared;
    const View& view;
    const DetailOptions& options;
    const ModelTextures& textures;
    Sampling wanted;
    std::function<ShaderLimits(const TraceModel&)> limits_of;
    const Workers* workers = nullptr; ///< null: the thread that asks works alone
    std::function<bool()> cancelled;  ///< asked often, by many threads
    /// If it is set, called once, after the first few rays: with a model, and the seconds that one sample for
    /// each pixel of its picture seems to take. Nothing that it does with the model changes the result,
    /// unless it has shells made.
    std::function<void(const TraceModel&, double)> on_first_look;
    std::shared_ptr<TraceBasis> basis = nullptr; ///< of `prepared`, or null: it is made anew
};

/// Tries rays over the whole picture, and predicts what all of them take. Where that is more than
/// options.work_seconds, it culls more and takes fewer samples, so that the picture looks least the worse
/// for it (loss_of_samples()); at last it gives rays up earlier. It also culls more where a model takes more
/// memory than there is (`out_of_memory`). If none fits, it throws std::bad_alloc. Only counts decide, so
/// the result is the same whatever the machine and its threads. Nothing where `cancelled` said true.
std::optional<FittedModel> fit_work(FitRequest request);

} // namespace graftal
