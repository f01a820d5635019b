#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "tools/graftal/options.h"

namespace graftal {

void add_export(CLI::App& app, Options& options);

/// The problem with options that are each right, or "".
std::string complete_export(Options& options);

} // namespace graftal
