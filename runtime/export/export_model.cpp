#include "runtime/export/export_model.h"

#include <utility>

#include <fmt/format.h>

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

/// What a node and a part take, with all that is made of them.
SceneLimits scene_limits(std::uint64_t memory_bytes) {
    constexpr std::uint64_t bytes_of_node = 1024, bytes_of_part = 256;
    return {static_cast<std::size_t>(memory_bytes / bytes_of_node),
            static_cast<std::size_t>(memory_bytes / bytes_of_part)};
}

void note_what_is_missing(const ExportedScene& scene, Span model, Diagnostics& diagnostics) {
    if (scene.left_out_planes)
        diagnostics.note(model, "planes have no end, so that graftal leaves them out of the file");
    if (scene.thickened > 0)
        diagnostics.note(model, fmt::format("a map leaves no thickness to {} parts: graftal gives them a "
                                            "little, since files cannot place such parts",
                                            scene.thickened));
}

/// As export_model(), except that a stage that is cancelled throws Cancelled.
std::optional<std::string> export_whole(PictureSession& session, const ExportModelOptions& options,
                                        Compilation& compilation) {
    const ExportFormat* const format = find_export_format(options.file.output);
    GRAFTAL_CHECK(format, "export: no such format");
    const std::shared_ptr<const AnalysedModel> model = session.analysed(options.compile, compilation);
    if (!model) return std::nullopt;
    const StageOptions stages = export_stages(options, *model);
    const std::shared_ptr<const ViewedModel> viewed = session.viewed(stages, compilation);
    if (!viewed) return std::nullopt;
    const std::shared_ptr<const PreparedCut> prepared = session.prepared(stages, compilation);
    if (!prepared) return std::nullopt;
    const Graph& graph = viewed->model->graph;
    const Span root = graph.objects[graph.root].span;
    std::optional<ExportedScene> scene =
        build_scene(*prepared, viewed->view, resolved(stages.detail, *viewed), format->meshes, root,
                    scene_limits(options.file.memory_bytes), session.control(), compilation.diagnostics);
    if (!scene) return std::nullopt;
    note_what_is_missing(*scene, root, compilation.diagnostics);
    ExportReport report;
    bool too_large = false;
    compilation.status = format->write({*scene, viewed->view, options.file, root, session.textures(),
                                        session.control().cancel, compilation.diagnostics, too_large},
                                       report);
    if (too_large) {
        const Status found = std::exchange(compilation.status, Status());
        compilation.diagnostics.error(root, found.message()).with_hint("allow more with --limit");
    }
    if (!compilation.status.ok() || compilation.diagnostics.has_errors()) return std::nullopt;
    const SceneCounts counts = count(*scene);
    return fmt::format("{} leaves: {}", in_words(counts.leaves), report.summary);
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
