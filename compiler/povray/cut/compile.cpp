#include "compiler/povray/cut/compile.h"

#include <utility>

#include <fmt/format.h>

#include "compiler/graph/planes.h"
#include "compiler/session/stage_clock.h"
#include "compiler/session/stages.h"

namespace graftal {

namespace {

/// True, after an error, if an operand holds a half space: POV-Ray's pictures of those differ from ours.
bool refuse_half_spaces(const AnalysedModel& model, Diagnostics& diagnostics) {
    const std::vector<bool> holds_plane = plane_holders(model.graph, model.components);
    for (const Object& object : model.graph.objects) {
        if (!object.is_combined()) continue;
        for (const Instance& instance : object.instances) {
            if (!holds_plane[instance.master]) continue;
            diagnostics
                .error(instance.span,
                       fmt::format("'{}' is cut by a plane, which graftal does not write for POV-Ray",
                                   object.name))
                .with_hint("use '--engine native', or a large cube in place of the plane");
            return true;
        }
    }
    return false;
}

} // namespace

std::shared_ptr<const CompiledModel> compile_scene(Session& session, const StageOptions& options,
                                                   Compilation& compilation, const CutOptions& cut_options) {
    const std::shared_ptr<const ViewedModel> viewed = session.viewed(options, compilation);
    if (!viewed || refuse_half_spaces(*viewed->model, compilation.diagnostics)) return nullptr;
    const auto cut = [&]() -> std::optional<Cut> {
        const std::shared_ptr<const PreparedCut> prepared = session.prepared(options, compilation);
        if (!prepared) return std::nullopt;
        return cut_prepared(viewed->model->graph, *prepared, viewed->view, resolved(options.detail, *viewed),
                            compilation.diagnostics, cut_options, session.control());
    };
    try {
        std::optional<Cut> made = StageClock(compilation.times).run("cut", cut);
        session.yield_memory();
        if (!made) return nullptr;
        return std::make_shared<const CompiledModel>(
            CompiledModel{viewed->model, viewed->steps, viewed->view, std::move(*made)});
    } catch (const Cancelled&) {
        compilation.status = Status::failure("interrupted");
        return nullptr;
    }
}

} // namespace graftal
