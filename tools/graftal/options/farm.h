#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "compiler/scene/scene.h"
#include "runtime/farm/sweep_axes.h"

namespace graftal {

struct Options;

enum class FarmAction { plan, submit, status, merge, clean, task };

/// Options of `graftal farm`.
struct FarmOptions {
    FarmAction action = FarmAction::plan;
    std::string folder; ///< of the job
    /// Words for other programs: for `plan`, the model and options of `render` or `animate`; for `submit`,
    /// options of sbatch.
    std::vector<std::string> words;
    // plan
    std::optional<ImageSize> tile;
    bool coarse = false; ///< a picture may be coarser than 2 pixels
    std::vector<SweepAxis> sweeps;
    std::string result;
    // submit
    std::optional<int> local;
    bool slurm = false;
    bool resume = false;
    int at_once = 0;         ///< of Slurm; 0: as many as it likes
    std::uint64_t group = 0; ///< tasks of an index of the array; 0: a minute's worth
    // task
    std::string tasks;
    // clean
    bool everything = false;
};

/// The command with its own commands.
void add_farm(CLI::App& app, Options& options);

/// `farm plan` and `farm submit` take words of other programs, too (FarmOptions::words): takes them out of
/// the command line, and leaves their own.
std::vector<std::string> take_foreign_words(std::vector<std::string>& words);

/// The problem with options that are each right, or "".
std::string complete_farm(Options& options);

} // namespace graftal
