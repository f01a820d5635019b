#include <cmath>

#include <fmt/format.h>

#include "compiler/detail/coarser.h"
#include "runtime/render/native.h"
#include "runtime/render/render.h"
#include "runtime/render/scene_files.h"
#include "runtime/system/interruption.h"
#include "tools/graftal/commands.h"
#include "tools/graftal/progress_bar.h"
#include "tools/graftal/report.h"

namespace graftal {

namespace {

std::string bytes_text(std::uint64_t bytes) {
    const double mib = static_cast<double>(bytes) / (1 << 20);
    return mib < 10'000 ? fmt::format("{:.0f} MiB", mib) : fmt::format("{:.1f} GiB", mib / 1024);
}

/// Whole numbers up to a million, then "4.7e+11".
std::string count_text(double count) {
    return count < 1e6 ? fmt::format("{:.0f}", count) : fmt::format("{:.2e}", count);
}

std::string cut_text(double leaves, std::uint64_t placements, std::uint64_t triangles, double error_px) {
    std::string text = fmt::format("{} leaves as {} placements", count_text(leaves), placements);
    if (triangles > 0) text += fmt::format(" of meshes with {} triangles", triangles);
    return text + (error_px > 0 ? fmt::format(", error {:.2g} px", error_px) : ", nothing left out");
}

RenderOptions render_options(const Options& options) {
    RenderOptions render;
    render.compile = options.compile;
    render.output = options.output;
    render.metadata = {"graftal " GRAFTAL_VERSION, options.description};
    render.format = options.format;
    render.antialias = options.antialias;
    render.threads = options.threads;
    render.keep = options.keep;
    render.unconfined = options.unconfined;
    return render;
}

/// "4 samples per pixel", "1 sample per pixel", "1 sample per 8x8 pixels"
std::string samples_text(double a_pixel) {
    if (a_pixel > 0 && a_pixel < 1) {
        const double block = std::round(std::sqrt(1 / a_pixel));
        return fmt::format("1 sample per {0:g}x{0:g} pixels", block);
    }
    return fmt::format("{:g} sample{} per pixel", a_pixel, a_pixel == 1 ? "" : "s");
}

std::string native_text(const NativeReport& report) {
    std::string text = report.finished ? "" : "unfinished: ";
    text += samples_text(report.samples_a_pixel);
    if (report.finer_share > 0)
        text += fmt::format(", in {:.2g} % of the picture {},", 100 * report.finer_share,
                            samples_text(report.finer_samples_a_pixel));
    text += fmt::format(" in {:.2f} s, {}", report.seconds, rays_text(report.rays, report.seconds));
    if (report.pictures > 1)
        text += fmt::format("; the first of {} pictures after {:.2f} s", report.pictures,
                            report.first_picture_seconds);
    return text;
}

int render_by_tracer(const Options& options) {
    ProgressBar bar(!options.quiet);
    NativeOptions native{render_options(options), options.progressive, {}};
    native.on_progress = [&](const NativeProgress& progress) {
        bar.show(progress.samples_a_pixel > 0 ? "refining" : "tracing", progress.fraction);
    };
    Compilation compilation;
    bar.show("compiling...");
    CommandSession session(options, options.operands.front());
    const bool viewed = session.viewed(native.render.compile, compilation) != nullptr;
    const Interruption interruption; // from here on something may be half written
    session.set_control({interruption.flag(), {}});
    std::optional<NativeReport> report;
    if (viewed) report = render_natively(session, native, compilation);
    bar.clear();
    const int status = conclude(options, compilation, interruption.signal());
    if (report && !options.quiet) say(fmt::format("{}: {}\n", options.output, native_text(*report)));
    return status;
}

} // namespace

int run_render(const Options& options) {
    if (options.engine == Engine::native) return render_by_tracer(options);
    ProgressBar bar(!options.quiet);
    RenderOptions render = render_options(options);
    render.on_progress = [&](const PovrayProgress& progress) { bar.show(progress); };
    render.on_start = [&](double seconds) {
        // Besides what the compiler takes, of the same work.
        if (!(seconds > 0.5 * options.compile.detail.work_seconds)) return;
        bar.clear();
        say(fmt::format("graftal: POV-Ray will take about {} seconds of one processor; '--engine native' is "
                        "faster; a larger --error or a smaller --memory or --size means less work\n",
                        readable_seconds(seconds)));
    };

    Compilation compilation;
    bar.show("compiling...");
    CommandSession session(options, options.operands.front());
    const bool compiled = session.compiled(render.compile, compilation) != nullptr;
    const Interruption interruption; // from here on something may be half written
    session.set_control({interruption.flag(), {}});
    std::optional<RenderReport> report;
    if (compiled) report = render_model(session, render, compilation);
    bar.clear();
    const int status = conclude(options, compilation, interruption.signal());
    if (report && !options.quiet)
        say(fmt::format(
            "{}: {}; POV-Ray {:.1f} s, peak {}, estimated {}\n", options.output,
            cut_text(report->leaf_count, report->placement_count, report->triangle_count, report->error_px),
            report->povray_seconds, bytes_text(report->peak_bytes), bytes_text(report->estimated_bytes)));
    return status;
}

int run_compile(const Options& options) {
    Compilation compilation;
    CommandSession session(options, options.operands.front());
    const std::shared_ptr<const CompiledModel> model = session.compiled(options.compile, compilation);
    const Interruption interruption;
    if (model) {
        const bool include = options.output.ends_with(".inc");
        compilation.status =
            options.output == "-"
                ? print_scene(*model, include, compilation.diagnostics, interruption.flag())
                : write_scene(*model, options.output, {.include = include, .identifier = options.identifier},
                              session.textures(), interruption.flag());
    }
    const int status = conclude(options, compilation, interruption.signal());
    if (status == exit_done && !options.quiet && options.output != "-")
        say(fmt::format("{}: {}\n", options.output,
                        cut_text(model->cut.leaf_count, model->cut.placement_count, model->cut.triangle_count,
                                 model->cut.error_px)));
    return status;
}

} // namespace graftal
