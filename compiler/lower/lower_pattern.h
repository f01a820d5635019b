#pragma once

#include "compiler/graph/material.h"
#include "compiler/lower/scene_fields.h"

namespace graftal {

/// Reads the solid pattern of a material, which has that of its base already. Errors go to `diagnostics`.
void lower_pattern(const SceneFields& fields, Diagnostics& diagnostics, Material& material);

} // namespace graftal
