#pragma once

#include <CLI/CLI.hpp>

#include "tools/graftal/options.h"

namespace graftal {

void add_studio(CLI::App& app, Options& options);

} // namespace graftal
