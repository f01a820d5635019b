#pragma once

#include <optional>
#include <vector>

#include "compiler/import/importer.h"
#include "compiler/import/l_system.h"
#include "compiler/support/tint.h"

namespace graftal {

/// The system of a file, whose expressions are ours; nothing after an error.
std::optional<LSystem> read_lpy(const ForeignFile& file);

/// The colours of a file's materials by their numbers: those of L-Py, and those that its editor appended to
/// the file.
std::vector<Rgb> lpy_colours(std::string_view text);

/// The system as a model of ours; of no use after an error.
Translation write_lpy(const ForeignFile& file, const ForeignModel& model, LSystem system);

} // namespace graftal
