#include "runtime/fit/fit_picture.h"

#include "compiler/scene/povray_units.h"

namespace graftal {

namespace {

/// Steps of culled parts' light in sampled pictures. Others keep POV-Ray's, to be equal to its pictures.
constexpr int light_steps_of_samples = 128;

/// Whether pixels are estimated, by samples that differ.
bool is_sampled(const Graph& graph, const View& view, const PictureWishes& wishes) {
    if (view.lens.radius > 0) return true;
    return !wishes.listed_lights && (view.has_soft_light() || view.sun_of_haze() || shows_blur(graph, view));
}

Sampling sampling_for(bool sampled, const View& view, const PictureWishes& wishes) {
    if (!sampled) return {.antialias = wishes.antialias};
    const SampleGoal goal = sample_goal(view.quality);
    return {.most_samples = wishes.samples.value_or(goal.most_samples),
            .noise_255 = wishes.noise_255.value_or(wishes.samples ? 0 : goal.noise_255),
            .denoise = wishes.denoise.value_or(view.quality != Quality::best)};
}

} // namespace

ShaderLimits limits_of(const PreparedGraph& prepared, const View& view, const PictureWishes& wishes) {
    constexpr double farthest_in_povray = 1e7;
    const Ball& ball = prepared.cut.nodes[prepared.cut.root].ball;
    DrawnExtent drawn;
    if (ball.radius > 0) {
        drawn.bounds.include(ball.centre - Vec3(ball.radius));
        drawn.bounds.include(ball.centre + Vec3(ball.radius));
    }
    ShaderLimits limits;
    limits.farthest = farthest_in_povray / choose_units(drawn, view.camera).scale;
    if (std::ranges::any_of(prepared.cut.materials, &Material::is_veil))
        limits.most_surfaces = Material::most_veils;
    if (wishes.listed_lights) limits.list = list_size(view.quality);
    return limits;
}

PicturePlan plan_picture(const PreparedView& prepared, const PictureWishes& wishes) {
    const View& view = prepared.viewed->view;
    PicturePlan plan;
    plan.sampled = is_sampled(prepared.viewed->model->graph, view, wishes);
    plan.detail = prepared.detail;
    plan.detail.work_seconds = wishes.work(view.quality);
    if (plan.sampled) plan.detail.light_steps = light_steps_of_samples;
    plan.wanted = sampling_for(plan.sampled, view, wishes);
    return plan;
}

std::optional<FittedModel> fit_picture(const PreparedView& prepared, const PictureWishes& wishes,
                                       const PicturePlan& plan, const Workers& workers,
                                       const std::function<bool()>& cancelled,
                                       const std::function<void(const TraceModel&, double)>& on_first_look,
                                       std::shared_ptr<TraceBasis> basis) {
    return fit_work(
        {.prepared = prepared.prepared,
         .view = prepared.viewed->view,
         .options = plan.detail,
         .textures = prepared.textures,
         .wanted = plan.wanted,
         .limits_of = [&](const TraceModel& tried) { return limits_of(tried.prepared, tried.view, wishes); },
         .workers = &workers,
         .cancelled = cancelled,
         .on_first_look = on_first_look,
         .basis = std::move(basis)});
}

PictureFit fit_of(const FittedModel& fitted, ImageSize size) {
    const DetailOptions& detail = fitted.model->options;
    return {.size = size,
            .error_px = detail.error_px,
            .error_world = detail.error_world,
            .most_visits = fitted.model->most_visits,
            .sampling = fitted.sampling,
            .seconds = fitted.seconds};
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
