#include "compiler/passes/pipeline.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "compiler/graph/verify.h"
#include "compiler/passes/drop_unreachable.h"
#include "compiler/passes/hoist_placements.h"
#include "compiler/passes/merge_equivalent.h"
#include "compiler/passes/split_into_halves.h"
#include "compiler/support/check.h"

namespace graftal {

namespace {

using Bounds = std::vector<ObjectBounds>;

/// Runs a pass that asks for no bounds.
template<Rewritten (*pass)(Graph)> Rewritten boundless(Graph graph, const Bounds&) {
    return pass(std::move(graph));
}

constexpr std::array<Pass, 2> before_analysis = {{
    {"drop_unreachable", "drops objects and materials that nothing drawn refers to",
     boundless<drop_unreachable>, true},
    {"merge_equivalent", "merges objects that unfold to the same thing, inside cycles too",
     boundless<merge_equivalent>, true},
}};

/// The first does not keep objects: see detail_passes().
constexpr std::array<Pass, 4> before_detail = {{
    {"hoist_placements", "moves what all instances of an object share to the object's users",
     boundless<hoist_placements>, false},
    {"drop_unreachable_again", "drops what hoisting and zooms have left without users",
     boundless<drop_unreachable>, true},
    {"merge_equivalent_again", "merges objects that hoisting has made equal", boundless<merge_equivalent>,
     true},
    {"split_into_halves", "takes objects that are their own mirror images apart", split_into_halves, true},
}};

std::map<ObjectId, Object> objects_on(const std::vector<GraphStep>& path, const Graph& graph) {
    std::map<ObjectId, Object> objects;
    for (const GraphStep& step : path)
        objects.try_emplace(step.object, graph.objects[step.object]);
    return objects;
}

} // namespace

std::span<const Pass> model_passes() {
    return before_analysis;
}

std::span<const Pass> detail_passes(bool keeps_objects) {
    return std::span(before_detail).subspan(keeps_objects ? 1 : 0);
}

BoundedGraph run_passes(std::span<const Pass> passes, BoundedGraph graph, const PipelineOptions& options,
                        std::vector<PassTime>* times, WorkMeter* meter) {
    const bool known = std::any_of(passes.begin(), passes.end(),
                                   [&](const Pass& pass) { return options.stop_after == pass.name; });
    GRAFTAL_CHECK(known || options.stop_after.empty(), fmt::format("no pass '{}'", options.stop_after));
    for (const Pass& pass : passes) {
        if (meter) meter->add(graph.graph.objects.size());
        const auto begin = std::chrono::steady_clock::now();
        const std::map<ObjectId, Object> before = objects_on(graph.path, graph.graph);
        Rewritten after = pass.run(std::move(graph.graph), graph.bounds);
        graph.graph = std::move(after.graph);
        for (GraphStep& step : graph.path)
            step = followed(after.renumbering, step, before.at(step.object), graph.graph);
        if (!graph.bounds.empty()) graph.bounds = carried_over(after.renumbering, graph.bounds);
        check_verified(graph.graph, fmt::format("after pass {}", pass.name));
        const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
        if (times) times->push_back({pass.name, elapsed.count()});
        if (options.after_each) options.after_each(pass, graph.graph);
        if (options.stop_after == pass.name) break;
    }
    return graph;
}

} // namespace graftal
