#pragma once

#include "tools/graftal/options.h"

namespace graftal {

// One row a command, and the functions that run them. Each returns the exit status: 0 done, 1 the model or
// the result is at fault, 3 the environment, 128 + n after signal n.

inline constexpr int exit_done = 0;
inline constexpr int exit_fault = 1;
inline constexpr int exit_usage = 2;
inline constexpr int exit_environment = 3;

/// Meaning of an output that is a folder: the command writes none, writes into it, or writes the folder
/// itself.
enum class FolderAsOutput { refused, holds_files, is_written };

/// One row of the table in options.cpp: all that there is to a command.
struct Command {
    const char* name;
    const char* summary;
    void (*add)(CLI::App&, Options&);  ///< adds its options
    std::string (*complete)(Options&); ///< says what is wrong with options that are each right, or ""
    int (*run)(const Options&);        ///< returns the exit status
    const char* ending = ".png";       ///< of a usual output
    FolderAsOutput folder = FolderAsOutput::refused;
};

int run_render(const Options& options);
int run_watch(const Options& options); ///< `render --watch`
int run_animate(const Options& options);
int run_points(const Options& options);
int run_collage(const Options& options);
int run_fit(const Options& options);
int run_fit_blocks(const Options& options);  ///< `fit --blocks`
int run_render_pifs(const Options& options); ///< `render FILE.pifs`
int run_compile(const Options& options);
int run_export(const Options& options);
int run_check(const Options& options);
int run_stats(const Options& options);
int run_print(const Options& options);
int run_graph(const Options& options);
int run_import(const Options& options);
int run_compare(const Options& options);
int run_studio(const Options& options);
int run_format(const Options& options);
int run_lsp(const Options& options);

int run_farm(const Options& options);
int run_farm_plan(const Options& options);
int run_farm_task(const Options& options);
int run_farm_submit(const Options& options);
int run_farm_status(const Options& options);
int run_farm_merge(const Options& options);
int run_farm_clean(const Options& options);

} // namespace graftal
