#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "compiler/graph/settings.h"
#include "compiler/inst/parse/ast.h"
#include "compiler/support/affine.h"
#include "compiler/support/control.h"

namespace graftal {

/// The model around a scatter, as far as the scatter needs to know it.
struct ScatterContext {
    const Environment& environment;
    const SceneSettings& settings;     ///< for what `ground` is
    std::optional<std::uint64_t> seed; ///< `--seed`, which gives every scatter other numbers
    std::size_t most = 0;              ///< places that the graph has room for
    WorkMeter* meter = nullptr;        ///< counts random numbers and places; null: nobody does
};

/// One instance that a scatter makes, before the transforms and the material of its group.
struct ScatteredPlace {
    std::size_t master = 0; ///< index among the group's
    Affine parent_from_child;
    Tint tint;
};

/// Takes what a scatter makes: how many at first, then one after the other, of which there may be millions.
struct ScatterTaker {
    std::function<void(std::size_t count)> begin;
    std::function<void(const ScatteredPlace&)> take;
};

/// Chooses the places of the group, which must be a scatter, and what stands on each. Errors: numbers out of
/// range, areas that are empty or unknown, and places that do not fit; then nothing is taken.
void lower_scatter(const InstGroup& group, const ScatterContext& context, const ScatterTaker& taker,
                   Diagnostics& diagnostics);

/// Later tints in front. A single one keeps its bits.
Tint composed(const std::vector<Tint>& tints);

} // namespace graftal
