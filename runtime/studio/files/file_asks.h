#pragma once

#include <nlohmann/json.hpp>

#include "runtime/studio/studio_home.h"
#include "runtime/studio/studio_state.h"

namespace graftal {

/// The file that a `write` asks for. Throws BadMessage.
FileJob file_job(const StudioState& state, const nlohmann::json& ask);

} // namespace graftal
