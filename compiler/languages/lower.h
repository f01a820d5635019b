#pragma once

#include <optional>
#include <string>

#include "compiler/graph/graph.h"
#include "compiler/lower/lower_options.h"
#include "compiler/support/diagnostics.h"
#include "compiler/support/source.h"

namespace graftal {

/// The graph of a model, and what lowering noted of it.
struct LoweredText {
    /// Verified. Nothing after errors, of an orbit, and where LowerOptions::may_draw_nothing applies.
    std::optional<Graph> graph;
    LowerNotes notes;
};

/// Lowers the text of a model, and all that it uses. `name` may name a model in a foreign file, which the
/// translator of `help` translates first. The language follows the name (languages.h), for "-" (standard
/// input) the text. Bad input is reported to `diagnostics` and gives nothing. Used files are looked up beside
/// the file that names them. The flag of `help` ends it by Cancelled.
LoweredText lower_text(const std::string& name, std::string text, const LowerOptions& options,
                       SourceMap& sources, Diagnostics& diagnostics, const LowerHelp& help = {});

/// The extension of the language of a model, whose file is the first in `sources`: by its name, for standard
/// input by its text, for a foreign file by its translation; else whatever follows the dot of the name.
std::string model_language(const SourceMap& sources);

} // namespace graftal
