#include "compiler/passes/pipeline.h"

#include <algorithm>
#include <array>
#include <chrono>

#include <fmt/format.h>

#include "compiler/graph/verify.h"
#include "compiler/passes/drop_unreachable.h"
#include "compiler/passes/merge_equivalent.h"
#include "compiler/support/check.h"

namespace graftal {

namespace {

constexpr std::array<Pass, 2> passes = {{
    {"drop_unreachable", "drops objects and materials that nothing drawn refers to", drop_unreachable, true},
    {"merge_equivalent", "merges objects that unfold to the same thing, inside cycles too", merge_equivalent,
     false},
}};

} // namespace

std::span<const Pass> pipeline() {
    return passes;
}

Graph run_pipeline(Graph graph, const PipelineOptions& options, std::vector<PassTime>* times) {
    const bool known = std::any_of(passes.begin(), passes.end(),
                                   [&](const Pass& pass) { return options.stop_after == pass.name; });
    GRAFTAL_CHECK(known || options.stop_after.empty(), fmt::format("no pass '{}'", options.stop_after));
    for (const Pass& pass : passes) {
        if (options.keep_names && !pass.keeps_names) continue;
        const auto begin = std::chrono::steady_clock::now();
        graph = pass.run(std::move(graph));
        check_verified(graph, fmt::format("after pass {}", pass.name));
        const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
        if (times) times->push_back({pass.name, elapsed.count()});
        if (options.after_each) options.after_each(pass, graph);
        if (options.stop_after == pass.name) break;
    }
    return graph;
}

} // namespace graftal
