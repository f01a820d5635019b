#pragma once

// Problems with options that are each right: together, or for the file that is asked for.

#include <string>

#include <CLI/CLI.hpp>

#include "tools/graftal/options.h"

namespace graftal {

/// The problem with options beside --watch, or "".
std::string refusal_to_watch(const Options& options);

/// The problem with the size of a picture, or of the part of it that is wanted; or "".
std::string refusal_of_size(const Options& options);

/// The problem with an option of `render` for a .pifs file, or "": it has no camera, parts or light.
std::string refusal_of_pifs(const CLI::App& command, const Options& options);

/// The problem with an option of `animate` for a .usda file, or "": nothing draws it.
std::string refusal_of_usd(const CLI::App& command);

/// The engine's refusal of a picture, or "".
std::string refusal_of_engine(const Options& options);

} // namespace graftal
