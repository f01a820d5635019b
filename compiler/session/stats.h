#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "compiler/detail/shell/box_count.h"
#include "compiler/session/values.h"

namespace graftal {

/// The text of `graftal stats --json` for a model that is drawn to `steps` levels (levels_of()): one object,
/// its keys in a fixed order. `sources`: those that the model was made of.
/// `boxes`: a count of it, if one was asked for.
std::string stats_json(const AnalysedModel& model, std::optional<unsigned> steps, const SourceMap& sources,
                       const BoxCount* boxes = nullptr);

/// The text of `graftal stats` for people, one line a key.
std::string stats_text(const AnalysedModel& model, std::optional<unsigned> steps, const SourceMap& sources,
                       const BoxCount* boxes = nullptr);

/// A key of stats_text(), without the name of a family: "contraction rate", "families members".
struct StatsKey {
    std::string_view name;
    std::string_view meaning;
};

/// The keys that stats_text() may print, in its order. Each key that it prints is one of them.
std::span<const StatsKey> stats_keys();

} // namespace graftal
