#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/graph/graph.h"

namespace graftal {

/// One pass: Graph -> Graph, never changing what unfold() gives (tests/property holds each to it).
struct Pass {
    const char* name;    ///< its function, its files, its `--dump-after` name and its test folder
    const char* summary; ///< one line for `--help-passes`
    Graph (*run)(Graph);
    bool keeps_names; ///< every object that is left has the name and the instances, in order, that it had
};

/// All passes in the order in which they run.
std::span<const Pass> pipeline();

struct PassTime {
    std::string name;
    double seconds = 0;
};

struct PipelineOptions {
    std::string stop_after;  ///< run up to and with this pass; empty: all
    bool keep_names = false; ///< leave out the passes that do not: addresses are to be found
    std::function<void(const Pass&, const Graph&)> after_each; ///< for --dump-after; may be empty
};

/// Runs the passes in order and verifies the graph after each; aborts, naming the pass, if one broke it.
/// Requires that `stop_after` is empty or names a pass.
Graph run_pipeline(Graph graph, const PipelineOptions& options = {}, std::vector<PassTime>* times = nullptr);

} // namespace graftal
