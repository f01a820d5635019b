#pragma once

#include <vector>

#include "compiler/graph/material.h"

namespace graftal {

/// The materials that every model may name without defining them, in the order of docs/language.md. A
/// model's own material of the same name takes precedence. None absorbs: that has a length, which only the
/// model knows.
const std::vector<Material>& named_materials();

} // namespace graftal
