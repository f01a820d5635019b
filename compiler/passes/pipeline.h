#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "compiler/analysis/bounding.h"
#include "compiler/analysis/contraction.h"
#include "compiler/graph/graph.h"
#include "compiler/passes/renumbering.h"
#include "compiler/support/control.h"

namespace graftal {

/// One pass: Graph -> Graph, never changing what unfold() gives (tests/property holds each to it).
struct Pass {
    const char* name;    ///< unique: its function, files and test; of a function's second row, with `_again`
    const char* summary; ///< one line for `--help-passes`
    Rewritten (*run)(Graph, const std::vector<ObjectBounds>&); ///< the bounds may be empty before analysis
    bool settles;                                              ///< a second run changes nothing
};

/// All passes that run before analysis, in their order: what is printed, counted and analysed is the graph
/// after them.
std::span<const Pass> model_passes();

/// All passes that run on what is drawn, after analysis and after a zoom has given the graph its root.
/// They need the bounds. `keeps_objects`: without hoist_placements, which dissolves objects of one instance
/// into their users.
std::span<const Pass> detail_passes(bool keeps_objects = false);

struct PassTime {
    std::string name;
    double seconds = 0;
};

/// Sees the graph after each pass, for --dump-after; may be empty.
using PassObserver = std::function<void(const Pass&, const Graph&)>;

struct PipelineOptions {
    std::string stop_after; ///< run up to and with this pass; empty: all
    PassObserver after_each;
};

/// A graph and what the passes carry over.
struct BoundedGraph {
    Graph graph;
    std::vector<ObjectBounds> bounds; ///< of its objects; empty before analysis
    std::vector<GraphStep> path = {}; ///< instances that somebody follows; only before analysis
};

/// Runs the passes in order, carries over what is known, and verifies the graph after each; throws, naming
/// the pass, if one broke it. Requires that `stop_after` is empty or names a pass of these. The meter, if
/// any, counts objects before each pass.
BoundedGraph run_passes(std::span<const Pass> passes, BoundedGraph graph, const PipelineOptions& options = {},
                        std::vector<PassTime>* times = nullptr, WorkMeter* meter = nullptr);

} // namespace graftal
