#include <fmt/format.h>

#include "compiler/detail/coarser.h"
#include "runtime/points/draw_points.h"
#include "runtime/render/gpu_engine.h"
#include "runtime/system/disk_files.h"
#include "runtime/system/interruption.h"
#include "tools/graftal/commands.h"
#include "tools/graftal/progress_bar.h"
#include "tools/graftal/report.h"

namespace graftal {

namespace {

PointsOptions points_options(const Options& options) {
    PointsOptions points;
    points.compile = options.render.compile;
    points.output = options.render.output;
    points.format = options.render.format;
    points.metadata = options.render.metadata;
    points.points = options.points.points;
    points.colour = options.points.colour;
    points.tone = options.points.tone;
    points.card = options.points.card;
    points.threads = options.render.threads;
    points.gpu = options.engine->name == gpu_engine.name;
    if (!options.render.devices.empty()) points.device = options.render.devices.front();
    return points;
}

/// Says what many points take, within a factor of five: it depends on how deep their parts lie.
void say_what_points_take(const PointsOptions& points) {
    constexpr double points_a_second = 2e7, worth_saying_s = 60;
    const double seconds = static_cast<double>(point_count(points)) / points_a_second;
    if (seconds > worth_saying_s)
        say(fmt::format("graftal: {} points will take about {} seconds of one processor; ask for fewer "
                        "points with --points\n",
                        point_count(points), readable_seconds(seconds)));
}

std::string done_text(const Options& options, const PointsReport& report) {
    std::string text = fmt::format("{}: {} points", options.render.output, report.points);
    if (report.inside < report.points)
        text += fmt::format(", {:.3g} % of them in the picture",
                            100 * static_cast<double>(report.inside) / static_cast<double>(report.points));
    const double millions = 1e-6 * static_cast<double>(report.points) / std::max(report.seconds, 1e-9);
    text += fmt::format(", in {:.2f} s, {:.3g} million per second", report.seconds, millions);
    return text + (report.device.empty() ? "\n" : fmt::format(" by {}\n", report.device));
}

} // namespace

int run_points(const Options& options) {
    ProgressBar bar(!options.quiet);
    PointsOptions points = points_options(options);
    points.on_progress = [&](double fraction) { bar.show("points", fraction); };
    if (!options.quiet && !points.gpu) say_what_points_take(points);
    Compilation compilation;
    bar.show("compiling...");
    std::vector<std::string> uses;
    const HeardFiles files(disk_files(), [&](const std::string& path) { uses.push_back(path); });
    CommandSession session(options, options.operands.front(), Keep::nothing, files);
    const Interruption interruption;
    session.set_control({interruption.flag(), {}});
    StageOptions compile = points.compile;
    compile.lower.may_be_orbit = true; // as draw_points() has it
    std::optional<PointsReport> report;
    if (session.lowered(compile, compilation) && !refuse_own_file(options, uses, compilation))
        report = draw_points(session, points, compilation);
    bar.clear();
    const int status = conclude(options, compilation, interruption.signal());
    if (report && !options.quiet) say(done_text(options, *report));
    return status;
}

} // namespace graftal
