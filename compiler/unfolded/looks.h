#pragma once

#include <optional>

#include "compiler/support/diagnostics.h"
#include "compiler/unfolded/scene.h"

namespace graftal {

/// Where a file has colours.
enum class TintsOn {
    leaves,    ///< a part looks the same wherever it is placed
    instances, ///< or an instance colours all below it that has no colour of its own
};

struct LookLimits {
    std::size_t nodes = 1'000'000;
    std::size_t wanted_parts = SIZE_MAX; ///< more only where tints can be told apart no less
    TintsOn tints = TintsOn::leaves;
};

/// A scene whose leaves know how they look: a node is there once for each tint and material that it is
/// placed with, and none has a cell. Where that makes too much, tints are told apart less finely, and a
/// warning says so. A part below a tint that covers nearly all of it then has its mean colour. Nothing,
/// after an error, if even that is too much.
std::optional<UnfoldedScene> resolve_looks(const UnfoldedScene& scene, const LookLimits& limits, Span model,
                                           Diagnostics& diagnostics);

} // namespace graftal
