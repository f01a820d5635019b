#include <fmt/format.h>

#include "runtime/export/export_model.h"
#include "runtime/system/interruption.h"
#include "tools/graftal/commands.h"
#include "tools/graftal/progress_bar.h"
#include "tools/graftal/report.h"

namespace graftal {

int run_export(const Options& options) {
    ExportModelOptions wanted;
    wanted.compile = options.render.compile;
    wanted.error_asked = options.error_asked;
    wanted.file = options.file;
    wanted.file.memory_bytes = options.render.compile.detail.memory_bytes;
    wanted.file.output = options.render.output;
    wanted.file.metadata = options.render.metadata;

    ProgressBar bar(!options.quiet);
    bar.show("exporting...");
    Compilation compilation;
    CommandSession session(options, options.operands.front(), Keep::for_views);
    const Interruption interruption;
    session.set_control({interruption.flag(), {}});
    const std::optional<std::string> written = export_model(session, wanted, compilation);
    bar.clear();
    const int status = conclude(options, compilation, interruption.signal());
    if (written && status == exit_done && !options.quiet)
        say(fmt::format("{}: {}\n", options.render.output, *written));
    return status;
}

} // namespace graftal
