#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compiler/graph/components.h"
#include "compiler/graph/graph.h"

namespace graftal {

/// The primitives that an unfolding to `steps` levels draws (see graph.h, "Levels"), exact, in decimal; a
/// fitted proxy counts as one. Ending graphs need no steps. Nothing where an unending graph has no steps or
/// more than `max_counted_steps`. Nothing where the number has over `max_counted_digits` digits or costs
/// over some seconds to add up: O(graph * steps * digits), equal objects counted once.
inline constexpr unsigned max_counted_steps = 100'000;
inline constexpr unsigned max_counted_digits = 1'000'000;
std::optional<std::string> count_leaves(const Graph& graph, const Components& components,
                                        std::optional<unsigned> steps);

/// Similarity dimension of the limit set: the s at which [sum r_e^s] over the graph has spectral radius 1,
/// the largest over components reachable from the root. Nothing for ending graphs, or where an instance
/// within a cycle is no similarity. Exact where the open set condition holds, an upper bound otherwise.
std::optional<double> similarity_dimension(const Graph& graph, const Components& components);

} // namespace graftal
