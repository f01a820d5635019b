#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "runtime/render/animate.h"
#include "tools/graftal/options.h"

namespace graftal {

/// Fills in what `animate` was not told; returns what is wrong with options that are each right, or "".
std::string complete_animation(Options& options);

/// Options for the animation itself.
AnimateOptions animate_options(const Options& options);

/// The version, the engine and all options except those that leave the frames as they are. An option missing
/// in the list of those costs frames that are drawn anew; it never lets a wrong one pass.
std::string frame_identity(const CLI::App& command, const Engine& engine);

} // namespace graftal
