#pragma once

#include <optional>
#include <string>

#include "compiler/session/values.h"

namespace graftal {

/// What `graftal stats` says of a model that is drawn to so many levels (levels_of()): one JSON object, its
/// keys in a fixed order. `sources`: those that the model was made of.
std::string stats_json(const AnalysedModel& model, std::optional<unsigned> steps, const SourceMap& sources);

/// The same for people, one line a key.
std::string stats_text(const AnalysedModel& model, std::optional<unsigned> steps, const SourceMap& sources);

} // namespace graftal
