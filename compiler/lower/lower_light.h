#pragma once

// The scene statements that say how light comes, and how a picture takes it.

#include <vector>

#include "compiler/graph/settings.h"
#include "compiler/lower/lowering.h"
#include "compiler/lower/scene_fields.h"

namespace graftal {

LightSetting lower_light(const SceneFields& fields);
SkySetting lower_sky(const SceneFields& fields, Lowering& lowering);
HazeSetting lower_haze(const SceneFields& fields);
Film lower_film(const SceneFields& fields);

/// Reports a clear sky that has no sun to stand about, and haze that has none to show.
void check_suns(const std::vector<SceneStatement>& statements, const SceneSettings& settings,
                Diagnostics& diagnostics);

} // namespace graftal
