#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "tools/graftal/options.h"

namespace graftal {

/// Adds the options of `points` besides the model, the camera and those that all commands have.
void add_points_options(CLI::App& app, Options& options);
/// Fills in what `points` was not told; returns what is wrong with options that are each right, or "".
std::string complete_points(Options& options);

/// Adds the options of `collage`: the two files, and `--json`.
void add_collage_options(CLI::App& app, Options& options);

/// Adds all options of `fit`.
void add_fit_options(CLI::App& app, Options& options);
/// Names the model after the target; returns what is wrong with its name, or "".
std::string complete_fit(Options& options);

} // namespace graftal
