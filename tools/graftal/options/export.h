#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "runtime/export/export_model.h"
#include "tools/graftal/options.h"

namespace graftal {

void add_export(CLI::App& app, Options& options);

/// The problem with options that are each right, or "".
std::string complete_export(Options& options);

/// The options for the exporter.
ExportModelOptions export_options(const Options& options);

} // namespace graftal
