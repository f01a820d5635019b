#pragma once

#include <string>

#include "compiler/session/values.h"
#include "compiler/support/status.h"

namespace graftal {

/// Writes the model as SDL to `path`, and the palettes that it refers to beside it, each whole or not at all.
/// `include` gives the `.inc` form; `progress` adds the marks that the POV-Ray driver reads. An interruption
/// (interruption.h) ends it early as a failure. `identifier`: PovrayOptions::identifier.
Status write_scene(const CompiledModel& model, const std::string& path, bool include, bool progress,
                   const std::string& identifier = {});

/// The same to standard output. A model that needs palette files is an error: there is nowhere to put them.
Status print_scene(const CompiledModel& model, bool include, Diagnostics& diagnostics);

/// Fails if no file can be made at `path`: its folder is missing or closed, or it is a folder itself.
Status check_writable(const std::string& path);

} // namespace graftal
