#pragma once

#include <cstdint>

#include <nlohmann/json.hpp>

#include "compiler/session/session.h"
#include "runtime/studio/picture/progressive_picture.h"
#include "runtime/studio/studio_home.h"
#include "runtime/studio/studio_state.h"

namespace graftal {

/// The message `findings`. Offsets count UTF-16 units of the model's own text: a finding in a file that it
/// uses has the place that names this file.
nlohmann::json findings_message(std::uint32_t number, const Compilation& compilation);

/// The message `model` without its maps (docs/studio.md).
nlohmann::json model_message(const StudioState& state, const LoweredModel& lowered,
                             const AnalysedModel& analysed, const ViewedModel& viewed,
                             const SourceMap& sources);

/// The message `pass`.
nlohmann::json pass_message(std::uint32_t number, const ShownPass& shown);

/// The message `progress` of the job with this id.
nlohmann::json progress_message(std::uint32_t id, const FileShare& share);
/// Whether a share is to be told. Shares are told by thousandths, so that the end of each stage is, too.
bool is_news(const FileShare& share, const FileShare& told);

/// A camera as the page says it, which looks at a point this far away.
nlohmann::json camera_json(const Camera& camera, double distance);

nlohmann::json vector_json(Vec3 vector);
nlohmann::json box_json(const Box& box); ///< null for an empty one

} // namespace graftal
