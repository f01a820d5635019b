#include "runtime/render/fit_picture.h"

#include <algorithm>

#include "compiler/povray/povray_units.h"
#include "runtime/render/native_engine.h"
#include "runtime/render/samplings.h"

namespace graftal {

namespace {

/// A pixel's, before more is culled to save work.
constexpr int fewest_soft_samples = 2;
/// Of the light of what is culled. Other pictures keep POV-Ray's steps, to be equal to its.
constexpr int light_steps_of_samples = 128;

/// Whether pixels are estimated, by samples that differ.
bool is_sampled(const Graph& graph, const View& view, const RenderOptions& options) {
    if (view.lens.radius > 0) return true;
    return !options.listed_lights && (view.has_soft_light() || shows_blur(graph, view));
}

std::vector<Sampling> samplings_for(bool sampled, const View& view, const RenderOptions& options) {
    if (!sampled) return samplings_of(options.antialias, options.progressive);
    const SampleGoal goal = sample_goal(view.quality);
    return samplings_of_soft_light(options.samples.value_or(goal.most_samples),
                                   options.noise_255.value_or(options.samples ? 0 : goal.noise_255),
                                   options.progressive);
}

} // namespace

ShaderLimits limits_of(const TraceModel& model, const RenderOptions& options) {
    constexpr double farthest_in_povray = 1e7;
    const Ball& ball = model.prepared.cut.nodes[model.prepared.cut.root].ball;
    DrawnExtent drawn;
    if (ball.radius > 0) {
        drawn.bounds.include(ball.centre - Vec3(ball.radius));
        drawn.bounds.include(ball.centre + Vec3(ball.radius));
    }
    ShaderLimits limits;
    limits.farthest = farthest_in_povray / choose_units(drawn, model.view.camera).scale;
    if (options.listed_lights) limits.list = list_size(model.view.quality);
    return limits;
}

PicturePlan plan_picture(const PreparedView& prepared, const RenderOptions& options) {
    const View& view = prepared.viewed->view;
    PicturePlan plan;
    plan.sampled = is_sampled(prepared.viewed->model->graph, view, options);
    plan.detail = prepared.detail;
    plan.detail.work_seconds = options.work(view.quality, plan.sampled);
    if (plan.sampled) plan.detail.light_steps = light_steps_of_samples;
    Looks& looks = plan.looks;
    looks.wanted = samplings_for(plan.sampled, view, options);
    looks.tried = plan.detail.culls() ? with_fewer_samples(looks.wanted, view.size,
                                                           most_for_samples * plan.detail.work_seconds)
                                      : looks.wanted;
    // Noise is better than parts that are missing.
    Sampling& finest = looks.tried.back();
    if (plan.sampled && plan.detail.culls())
        finest.most_samples = std::min(finest.most_samples, fewest_soft_samples);
    return plan;
}

FittedModel fit_picture(const PreparedView& prepared, const RenderOptions& options,
                        const std::function<bool()>& cancelled,
                        const std::function<void(const TraceModel&, double)>& on_first_look,
                        PicturePlan& plan) {
    Looks& looks = plan.looks;
    const double samples = samples_a_pixel(looks.tried);
    const double fewest = samples_a_pixel(with_fewer_samples(looks.tried, prepared.viewed->view.size, 0));
    FittedModel fitted = fit_work(
        prepared.prepared, prepared.viewed->view, plan.detail, prepared.textures, samples, fewest,
        [&](const TraceModel& tried) { return limits_of(tried, options); }, options.threads, cancelled,
        on_first_look);
    looks.affordable = looks.tried;
    if (fitted.samples_cut || fitted.rays_cut)
        looks.affordable = within_seconds(looks.tried, fitted.seconds / samples, fitted.allowed_seconds);
    else if (plan.sampled)
        looks.affordable = with_more_samples(looks.tried, looks.wanted.back(), fitted.seconds / samples,
                                             fitted.allowed_seconds);
    return fitted;
}

PictureFit fit_of(const FittedModel& fitted, const PicturePlan& plan, ImageSize size) {
    const Looks& looks = plan.looks;
    const DetailOptions& detail = fitted.model->options;
    PictureFit fit{.error_px = detail.error_px,
                   .error_world = detail.error_world,
                   .most_visits = fitted.model->most_visits,
                   .sampling = looks.affordable.back()};
    fit.seconds = fitted.seconds * samples_a_pixel(looks.affordable) / samples_a_pixel(looks.tried) +
                  least_seconds(looks.affordable, size);
    return fit;
}

std::unique_ptr<TraceModel> model_of(const PictureFit& fit, const PreparedView& prepared,
                                     const DetailOptions& detail) {
    DetailOptions fitted = detail;
    fitted.error_px = fit.error_px;
    fitted.error_world = fit.error_world;
    auto model =
        std::make_unique<TraceModel>(prepared.prepared, prepared.viewed->view, fitted, prepared.textures);
    model->most_visits = fit.most_visits;
    return model;
}

} // namespace graftal
