#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "runtime/studio/studio_state.h"

namespace graftal {

/// Whether an ask of this name is about the text alone: completion, hovering, names, layout, maps, variation.
bool is_about_text(const std::string& what);

/// The fields of the answer (docs/studio.md). Requires is_about_text(), and a state with a text. Throws
/// BadMessage.
nlohmann::json answer_about_text(const std::string& what, const nlohmann::json& ask,
                                 const StudioState& state);

} // namespace graftal
