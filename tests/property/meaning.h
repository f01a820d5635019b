#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/passes/pipeline.h"

namespace graftal::testing {

/// The leaves that a graph unfolds to at some depth, as sorted text: equal for graphs of equal meaning,
/// whatever their ids, names and order of instances.
struct Meaning {
    std::vector<std::string> leaves;
    bool complete = false; ///< false: there were more than `max_leaves`, so that `leaves` is no meaning
    bool operator==(const Meaning&) const = default;
};

Meaning meaning_of(const Graph& graph, unsigned steps, std::uint64_t max_leaves);

/// How often the law "each pass keeps the meaning" could be tried on a graph, and what it found.
struct LawCheck {
    unsigned depths_compared = 0;
    unsigned moved = 0;    ///< objects out of which a pass has taken a map
    unsigned parts = 0;    ///< into which passes have taken objects apart
    std::string violation; ///< of the first pass that broke a law; empty if none did
};

/// Runs each pass in turn, and holds it to: the graph stays verified; the meaning stays for 0 to `max_steps`
/// levels; a second run changes nothing, if it settles; the same text for the same graph. A graph with bounds
/// is one of exact maps: then proxies stay where the renumbering says that they are, and bounds hold the
/// objects of the new graph.
LawCheck check_laws(std::span<const Pass> passes, BoundedGraph graph, unsigned max_steps,
                    std::uint64_t max_leaves);

} // namespace graftal::testing
