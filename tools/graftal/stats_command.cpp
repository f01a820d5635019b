#include "compiler/session/stages.h"
#include "compiler/session/stats.h"
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
    const auto text = options.json ? stats_json : stats_text;
    return print_output(text(*model, levels_of(*model, compile.lower.steps), compilation.sources));
}

} // namespace graftal
