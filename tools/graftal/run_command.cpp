#include "tools/graftal/commands.h"

namespace graftal {

int run_command(const Options& options) {
    switch (options.command) {
    case Command::render:
        return options.watch ? run_watch(options) : run_render(options);
    case Command::animate:
        return run_animate(options);
    case Command::points:
        return run_points(options);
    case Command::collage:
        return run_collage(options);
    case Command::compile:
        return run_compile(options);
    case Command::check:
        return run_check(options);
    case Command::stats:
        return run_stats(options);
    case Command::print:
        return run_print(options);
    case Command::graph:
        return run_graph(options);
    case Command::import_foreign:
        return run_import(options);
    case Command::compare:
        return run_compare(options);
    case Command::farm:
        return run_farm(options);
    }
    return exit_usage;
}

} // namespace graftal
