#include "runtime/export/export_model.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "compiler/graph/refuse_combined.h"
#include "compiler/session/stages.h"
#include "compiler/support/check.h"

namespace graftal {

namespace {

/// Parts are left out for their size where somebody asked for that, and where nothing else ends the model.
StageOptions export_stages(const ExportModelOptions& options, const AnalysedModel& model) {
    StageOptions stages = options.compile;
    stages.detail.keeps_objects = true;
    const bool ends =
        !model.components.unending[model.graph.root] || levels_of(model, stages.lower.steps).has_value();
    if (ends && !options.error_asked) {
        stages.detail.error_px = 0;
        stages.detail.error_world.reset();
    }
    return stages;
}

/// Limits by the memory that a node and a part take, with all that is made of them.
SceneLimits scene_limits(std::uint64_t memory_bytes) {
    constexpr std::uint64_t bytes_of_node = 1024, bytes_of_part = 256;
    return {static_cast<std::size_t>(memory_bytes / bytes_of_node),
            static_cast<std::size_t>(memory_bytes / bytes_of_part)};
}

void note_what_is_missing(const UnfoldedScene& scene, Span model, Diagnostics& diagnostics) {
    if (scene.left_out_planes)
        diagnostics.note(model, "planes have no end, so that graftal leaves them out of the file");
    if (scene.thickened > 0)
        diagnostics.note(model, fmt::format("a map leaves no thickness to {} parts: graftal gives them a "
                                            "little, since files cannot place such parts",
                                            scene.thickened));
}

/// One way to write the model. Findings are those of this way.
struct Attempt {
    Compilation compilation;
    std::optional<std::string> written;
    Span root;
    bool too_large = false; ///< nothing is written, and a larger error may help
};

class Exporter {
  public:
    Exporter(PictureSession& session, const ExportModelOptions& options, const ExportFormat& format)
        : session_(session), options_(options), format_(format) {}

    Attempt attempt(const StageOptions& stages, std::uint64_t most_bytes) const {
        Attempt attempt;
        Compilation& compilation = attempt.compilation;
        const std::shared_ptr<const ViewedModel> viewed = session_.viewed(stages, compilation);
        if (!viewed) return attempt;
        const std::shared_ptr<const PreparedGraph> prepared = session_.prepared(stages, compilation);
        if (!prepared) return attempt;
        const Graph& graph = viewed->model->graph;
        if (refuse_combined(graph, fmt::format("a {} file", format_.extension), compilation.diagnostics))
            return attempt;
        const Span root = attempt.root = graph.objects[graph.root].span;
        std::optional<UnfoldedScene> scene = build_scene(
            *prepared, viewed->view, resolved(stages.detail, *viewed), format_.meshes, root,
            scene_limits(options_.file.memory_bytes), session_.control(), compilation.diagnostics);
        attempt.too_large = !scene;
        if (!scene) return attempt;
        note_what_is_missing(*scene, root, compilation.diagnostics);
        ExportOptions file = options_.file;
        file.most_bytes = most_bytes;
        ExportReport report;
        compilation.status =
            format_.write({*scene, viewed->view, file, root, session_.textures(), session_.control().cancel,
                           compilation.diagnostics, attempt.too_large},
                          report);
        if (attempt.too_large && !compilation.status.ok()) {
            const Status found = std::exchange(compilation.status, Status());
            compilation.diagnostics.error(root, found.message()).with_hint("allow more with --limit");
        }
        if (compilation.status.ok() && !compilation.diagnostics.has_errors())
            attempt.written =
                fmt::format("{} primitives: {}", in_words(count(*scene).leaves), report.summary);
        return attempt;
    }

    /// The finest error that makes a file of no more than `most_bytes`, of those that double from the default
    /// on; with a warning that begins with the `problem` of the whole model. The last attempt where none
    /// does.
    Attempt fitted(StageOptions stages, std::uint64_t most_bytes, const std::string& problem) const {
        constexpr double largest_error_px = 2048; // more than a usual picture is wide
        const double tried_px = stages.detail.error_px;
        for (double error_px = tried_px > 0 ? 2 * tried_px : options_.compile.detail.error_px;;
             error_px *= 2) {
            stages.detail.error_px = error_px;
            Attempt made = attempt(stages, most_bytes);
            if (made.too_large && error_px < largest_error_px) continue;
            if (made.written)
                made.compilation.diagnostics
                    .warning(made.root, fmt::format("{}; so graftal leaves out parts smaller than {:g} px",
                                                    problem, error_px))
                    .with_hint(
                        "choose with --error how much is left out, allow a larger file with --limit, or "
                        "choose .usda, which nests parts");
            return made;
        }
    }

  private:
    PictureSession& session_;
    const ExportModelOptions& options_;
    const ExportFormat& format_;
};

/// Does the work of export_model(), except that a stage that is cancelled throws Cancelled.
std::optional<std::string> export_whole(PictureSession& session, const ExportModelOptions& options,
                                        Compilation& compilation) {
    const ExportFormat* const format = find_export_format(options.file.output);
    GRAFTAL_CHECK(format, "export: no such format");
    const std::shared_ptr<const AnalysedModel> model = session.analysed(options.compile, compilation);
    if (!model) return std::nullopt;
    const StageOptions stages = export_stages(options, *model);
    const Exporter exporter(session, options, *format);
    Attempt made = exporter.attempt(stages, options.file.most_bytes);
    if (made.too_large && !options.error_asked) {
        const std::vector<Diagnostic>& found = made.compilation.diagnostics.all();
        const auto problem = std::ranges::find(found, Severity::error, &Diagnostic::severity);
        GRAFTAL_CHECK(problem != found.end(), "export: a model is too large without an error");
        Attempt fitted = exporter.fitted(stages, options.file.fitted_bytes, problem->message);
        if (!fitted.too_large) made = std::move(fitted);
    }
    compilation = std::move(made.compilation);
    return made.written;
}

} // namespace

std::optional<std::string> export_model(PictureSession& session, const ExportModelOptions& options,
                                        Compilation& compilation) {
    std::optional<std::string> written;
    try {
        written = export_whole(session, options, compilation);
    } catch (const Cancelled&) {
    }
    if (!written && session.control().cancel.raised()) compilation.status = Status::failure("interrupted");
    return written;
}

} // namespace graftal
