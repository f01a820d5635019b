#pragma once

#include <functional>
#include <optional>
#include <span>

#include "compiler/graph/graph.h"
#include "compiler/lsys/compile/module_table.h"

namespace graftal {

/// A model in the turtle's frame.
struct PlacedModel {
    ObjectId root = 0;
    Vec3 scale{1.0}; ///< across, along and above the turtle
};

/// Gives the model that `~NAME` with these parameters places; nothing after an error at the span.
using ModelPlacer = std::function<std::optional<PlacedModel>(SymbolId model, std::span<const double>, Span)>;

/// The scale that parameters ask for: none, one for all directions, or k1, k2 across and along, with sqrt|k1
/// k2| above, as `scale` has it, or k1, k2, k3; further ones do not count.
Vec3 placed_scale(std::span<const double> parameters);

} // namespace graftal
