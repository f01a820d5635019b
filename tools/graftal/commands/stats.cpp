#include "compiler/session/stats.h"
#include "compiler/session/stages.h"
#include "tools/graftal/commands.h"
#include "tools/graftal/report.h"

namespace graftal {

int run_stats(const Options& options) {
    Compilation compilation;
    StageOptions compile = inspecting(options, true);
    compile.lower.may_draw_nothing = true;
    CommandSession session(options, options.operands.front());
    const std::shared_ptr<const AnalysedModel> model = session.analysed(compile, compilation, true);
    const int status = conclude(options, compilation);
    if (!model || status != exit_done) return status;
    const std::optional<unsigned> steps = levels_of(*model, compile.lower.steps);
    return options.json ? print_output(stats_json(*model, steps, compilation.sources))
                        : print_output(stats_text(*model, steps, compilation.sources));
}

} // namespace graftal
