#pragma once

#include <optional>

#include "compiler/unfolded/scene.h"

namespace graftal {

/// A scene of the same leaves with at most `levels` parts on the way from the root to any. Keeps nodes at
/// even steps of height, and takes others apart. Nothing where that makes too many parts. Requires resolved
/// looks and levels > 0.
std::optional<UnfoldedScene> with_levels(const UnfoldedScene& scene, unsigned levels, std::size_t most_parts);

} // namespace graftal
