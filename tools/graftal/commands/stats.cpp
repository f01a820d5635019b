#include "compiler/session/stats.h"
#include "compiler/detail/work.h"
#include "compiler/session/stages.h"
#include "tools/graftal/commands.h"
#include "tools/graftal/commands/plant_stats.h"
#include "tools/graftal/report.h"

namespace graftal {

int run_stats(const Options& options) {
    if (options.plant) return run_plant_stats(options);
    Compilation compilation;
    StageOptions compile = inspecting(options, true);
    compile.lower.may_draw_nothing = true;
    CommandSession session(options, options.operands.front());
    const std::shared_ptr<const AnalysedModel> model = session.analysed(compile, compilation, true);
    std::optional<BoxCount> boxes;
    if (const auto prepared = model && options.boxes ? session.prepared(compile, compilation) : nullptr) {
        constexpr double share = 0.5; // of the work, which the stages before had, too
        const double moves = share * compile.detail.work_seconds * WorkRates::shell_points;
        boxes = count_boxes(prepared->cut, prepared->cut.root, prepared->root_steps,
                            static_cast<std::uint64_t>(moves));
        if (boxes->dimension == 0)
            compilation.diagnostics.note(
                model->graph.objects[model->graph.root].span,
                first_combined(model->graph) < model->graph.objects.size()
                    ? "no boxes are counted: a part of it is an intersection or a difference"
                    : "no dimension by boxes: it has none, or fewer than three counts end within the work");
    }
    const int status = conclude(options, compilation);
    if (!model || status != exit_done) return status;
    const std::optional<unsigned> steps = levels_of(*model, compile.lower.steps);
    const BoxCount* counted = boxes ? &*boxes : nullptr;
    return print_output(options.json ? stats_json(*model, steps, compilation.sources, counted)
                                     : stats_text(*model, steps, compilation.sources, counted));
}

} // namespace graftal
