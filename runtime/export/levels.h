#pragma once

#include <optional>

#include "runtime/export/exported_scene.h"

namespace graftal {

/// The same leaves with at most so many parts on the way from the root to any: nodes between are taken apart.
/// Every so many heights one is kept, as few as fit. Nothing where that makes too many parts. Requires
/// resolved looks and levels > 0.
std::optional<ExportedScene> with_levels(const ExportedScene& scene, unsigned levels, std::size_t most_parts);

} // namespace graftal
