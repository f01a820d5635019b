#include "compiler/povray/cut/compile.h"

#include <utility>

#include "compiler/session/stage_clock.h"
#include "compiler/session/stages.h"

namespace graftal {

std::shared_ptr<const CompiledModel> compile_scene(Session& session, const StageOptions& options,
                                                   Compilation& compilation, const CutOptions& cut_options) {
    const std::shared_ptr<const ViewedModel> viewed = session.viewed(options, compilation);
    if (!viewed) return nullptr;
    const auto cut = [&]() -> std::optional<Cut> {
        const std::shared_ptr<const PreparedGraph> prepared = session.prepared(options, compilation);
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
