#include "runtime/render/animate.h"

#include <set>

#include <fmt/format.h>

#include "runtime/export/export_animation.h"
#include "runtime/render/frame_clock.h"
#include "runtime/render/frame_store.h"
#include "runtime/system/interruption.h"
#include "runtime/system/worker_threads.h"
#include "tools/graftal/commands.h"
#include "tools/graftal/options/animate.h"
#include "tools/graftal/options/export.h"
#include "tools/graftal/progress_bar.h"
#include "tools/graftal/report.h"

namespace graftal {

namespace {

void show(ProgressBar& bar, const AnimationProgress& progress) {
    std::string text = fmt::format("frame {}/{}", progress.frame + 1, progress.frames);
    switch (progress.stage) {
    case AnimationProgress::Stage::measuring:
        return bar.show("measuring, " + text);
    case AnimationProgress::Stage::assembling:
        return bar.show("putting together",
                        static_cast<double>(progress.frame) / static_cast<double>(progress.frames),
                        ", " + text);
    case AnimationProgress::Stage::drawing:
        break;
    }
    if (progress.fraction) text += fmt::format(" at {:.0f} %", 100 * *progress.fraction);
    if (progress.seconds_left) text += fmt::format(", {} left", duration_text(*progress.seconds_left));
    bar.show(text);
}

/// Says once what many frames have to say.
class Warnings {
  public:
    explicit Warnings(ProgressBar& bar) : bar_(bar) {}
    void say_new(const Compilation& compilation) {
        const std::string text = compilation.diagnostics.render(compilation.sources);
        if (text.empty() || !said_.insert(text).second) return;
        bar_.clear();
        say(text);
    }

  private:
    ProgressBar& bar_;
    std::set<std::string> said_;
};

std::string estimate_text(const Options& options, const AnimationEstimate& estimate) {
    const int threads = WorkerThreads(options.render.threads).count();
    return fmt::format("graftal: {} frames take about {} in all, on {} processor{}\n", estimate.frames,
                       duration_text(estimate.seconds), threads, threads == 1 ? "" : "s");
}

std::string done_text(const Options& options, const AnimationOutcome& outcome) {
    std::string text = fmt::format("{}: {} frames, {:g} per second", options.render.output,
                                   options.animation.frames, options.animation.rate.per_second());
    if (outcome.found > 0) text += fmt::format("; {} were there before", outcome.found);
    const DrawReport& report = outcome.report;
    if (report.error_px) text += fmt::format("; error at most {:.2g} px", *report.error_px);
    if (report.rays.camera_rays > 0) text += "; " + rays_text(report.rays, report.trace_seconds);
    text += fmt::format("; {}\n", duration_text(outcome.seconds));
    if (outcome.strangers > 0)
        text += fmt::format("graftal: '{}' also holds {} frame{} of another animation\n",
                            options.render.output, outcome.strangers, outcome.strangers == 1 ? "" : "s");
    return text;
}

/// A text about the frames that an animation leaves behind undone, and how to go on.
std::string rest_text(const Options& options, const AnimationOutcome& outcome) {
    const std::size_t there = outcome.drawn + outcome.found;
    if (there == 0) return {};
    return fmt::format("graftal: {} of {} frames are in '{}'; the same command goes on from there\n", there,
                       options.animation.frames, frames_directory(options.render.output));
}

} // namespace

int run_animate(const Options& options) {
    ProgressBar bar(!options.quiet);
    Warnings warnings(bar);
    AnimateOptions animate = animate_options(options);
    animate.on_progress = [&](const AnimationProgress& progress) { show(bar, progress); };
    animate.on_estimate = [&](const AnimationEstimate& estimate) {
        constexpr double worth_a_word = 5;
        if (options.quiet || estimate.seconds < worth_a_word) return;
        bar.clear();
        say(estimate_text(options, estimate));
    };
    animate.on_compiled = [&](const Compilation& compilation) { warnings.say_new(compilation); };

    CommandSession session(options, options.operands.front(), Keep::for_views);
    const bool is_usd = animation_kind(animate.output) == AnimationKind::usd;
    const Interruption interruption;
    session.set_control({interruption.flag(), {}});
    const AnimationOutcome outcome = is_usd ? export_animation(session, animate, export_options(options))
                                            : animate_model(session, animate);
    bar.clear();
    if (!outcome.done && !outcome.frame.empty()) complain("at " + outcome.frame + ":");
    const int status = conclude(options, outcome.compilation, interruption.signal());
    if (!outcome.done && !is_usd) say(rest_text(options, outcome));
    if (outcome.done && !options.quiet) say(done_text(options, outcome));
    return status;
}

} // namespace graftal
