#pragma once

#include <optional>
#include <string>

#include "compiler/graph/graph.h"
#include "compiler/lower/lower_options.h"
#include "compiler/support/diagnostics.h"
#include "compiler/support/source.h"
#include "compiler/support/status.h"

namespace graftal {

/// Reads a model, and all that it uses, and lowers it to a verified graph. The language follows the file
/// name (`.inst`, `.rifs`, `.lsys`), for "-" (standard input) the first word of the text. Bad input is
/// reported to `diagnostics` and gives nothing; a root file that cannot be read gives nothing and a failed
/// `status`. Used files are looked up beside the file that names them. The flag of `help` ends it by
/// Cancelled.
std::optional<Graph> lower_model(const std::string& path, const LowerOptions& options, SourceMap& sources,
                                 Diagnostics& diagnostics, Status& status, LowerNotes* notes = nullptr,
                                 const LowerHelp& help = {});

/// "inst", "rifs" or "lsys", by the name of the file, for standard input by its text; else whatever follows
/// the dot of the name. The file of the model itself is the first in `sources`.
std::string model_language(FileId file, const SourceMap& sources);

/// The same as lower_model for a text already at hand, as the model `name` (which decides the language and
/// where used files are looked up).
std::optional<Graph> lower_text(const std::string& name, std::string text, const LowerOptions& options,
                                SourceMap& sources, Diagnostics& diagnostics, LowerNotes* notes = nullptr,
                                const LowerHelp& help = {});

} // namespace graftal
