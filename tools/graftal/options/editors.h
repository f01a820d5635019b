#pragma once

#include <CLI/CLI.hpp>

#include "tools/graftal/options.h"

namespace graftal {

/// The options of `format`.
void add_format(CLI::App& app, Options& options);
/// `lsp` has none of its own.
void add_lsp(CLI::App& app, Options& options);
void add_studio(CLI::App& app, Options& options);

} // namespace graftal
