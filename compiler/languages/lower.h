#pragma once

#include <optional>
#include <string>

#include "compiler/graph/graph.h"
#include "compiler/lower/lower_options.h"
#include "compiler/support/diagnostics.h"
#include "compiler/support/source.h"
#include "compiler/support/status.h"

namespace graftal {

/// The graph of a model, and what lowering noted of it.
struct LoweredText {
    /// Verified. Nothing after errors, of an orbit, and where LowerOptions::may_draw_nothing applies.
    std::optional<Graph> graph;
    LowerNotes notes;
};

/// Reads a model, and all that it uses, and lowers it. The path may name a model in a foreign file
/// (importers.h), which is translated first. The language follows the file name (languages.h), for
/// "-" (standard input) the text. Bad input is reported to `diagnostics` and gives nothing; a root file that
/// cannot be read gives nothing and a failed `status`. Used files are looked up beside the file that names
/// them. The flag of `help` ends it by Cancelled.
LoweredText lower_model(const std::string& path, const LowerOptions& options, SourceMap& sources,
                        Diagnostics& diagnostics, Status& status, const LowerHelp& help = {});

/// Lowers a text already at hand as lower_model() lowers a file. The model's `name` decides the language and
/// where used files are looked up.
LoweredText lower_text(const std::string& name, std::string text, const LowerOptions& options,
                       SourceMap& sources, Diagnostics& diagnostics, const LowerHelp& help = {});

/// The extension of the language of a model, whose file is the first in `sources`: by its name, for standard
/// input by its text, for a foreign file by its translation; else whatever follows the dot of the name.
std::string model_language(const SourceMap& sources);

} // namespace graftal
