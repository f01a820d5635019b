#include "compiler/detail/prepare.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "compiler/detail/graph/build_detail_graph.h"
#include "compiler/detail/shadow/coverage.h"
#include "compiler/support/stage_price.h"

namespace graftal {

namespace {

/// Objects, comparisons and bodies after which the control is asked: some milliseconds.
constexpr std::uint64_t prepared_a_look = 20'000;

/// Where levels do not end, objects are cut for their size alone. A proxy then stands for all that is left
/// out. The form of an object's last level, a trunk without its twigs, would be too little.
void drop_endings(DetailGraph& cut) {
    for (DetailNode& node : cut.nodes)
        if (!node.terminal && !node.sealed) node.stop_edges.clear();
}

/// Parts that are drawn wider than they are make what holds them wider, too.
void mark_wide(DetailGraph& cut) {
    std::vector<std::vector<NodeId>> users(cut.nodes.size());
    std::vector<NodeId> wide;
    for (NodeId id = 0; id < cut.nodes.size(); ++id) {
        DetailNode& node = cut.nodes[id];
        for (const std::vector<DetailEdge>* edges : {&node.edges, &node.stop_edges})
            for (const DetailEdge& edge : *edges)
                users[edge.child].push_back(id);
        node.widens = node.sealed || node.shadowless;
        if (node.widens) wide.push_back(id);
    }
    while (!wide.empty()) {
        const NodeId id = wide.back();
        wide.pop_back();
        for (const NodeId user : users[id]) {
            if (cut.nodes[user].widens) continue;
            cut.nodes[user].widens = true;
            wide.push_back(user);
        }
    }
}

} // namespace

PreparedGraph prepare_graph(const Graph& graph, const Components& components,
                            const std::vector<ObjectBounds>& bounds, const PrepareOptions& options,
                            const Control& control, const PassObserver& after_each) {
    WorkMeter meter(control, "prepare", prepared_a_look);
    meter.charge(work_of_preparation(graph.objects.size(), instance_count(graph)));
    PreparedGraph prepared;
    BoundedGraph passed = run_passes(detail_passes(options.keeps_objects), {graph, bounds},
                                     {.stop_after = {}, .after_each = after_each}, nullptr, &meter);
    DetailGraph& cut = prepared.cut = build_detail_graph(std::move(passed.graph), passed.bounds, &meter);
    if (!options.steps) drop_endings(cut);
    prepared.symmetry = find_symmetry(cut);
    meter.add(prepared.symmetry.comparisons);
    if (options.culls || (components.unending[graph.root] && options.steps))
        fit_proxies(cut, prepared.symmetry, options.most_bodies, &meter);
    mark_wide(cut);
    mark_solid(cut);
    prepared.bounds = bounds[graph.root].box;
    prepared.instances = instance_count(graph);
    if (options.steps) prepared.root_steps = *options.steps;
    meter.charge(0);
    if (control.work) prepared.work_seconds = control.work->seconds();
    return prepared;
}

bool refuse_endless(const Graph& graph, const Components& components, const DetailOptions& options,
                    Diagnostics& diagnostics) {
    if (!components.unending[graph.root] || options.steps || options.culls()) return false;
    diagnostics
        .error(graph.objects[graph.root].span, "the recursion has no end, and no option limits its depth")
        .with_hint("set a depth with '--steps N', or a smallest size in pixels with --error");
    return true;
}

void note_shadowless(const DetailGraph& cut, const Graph& graph, Diagnostics& diagnostics) {
    const auto widens_proxy = [&](const DetailEdge& edge) { // the root itself is always drawn whole
        const DetailNode& node = cut.nodes[edge.child];
        return node.shadowless && node.cullable && !node.terminal;
    };
    if (std::ranges::none_of(
            cut.nodes, [&](const DetailNode& user) { return std::ranges::any_of(user.edges, widens_proxy); }))
        return;
    diagnostics
        .note(graph.objects[graph.root].span,
              "this figure is a curve or dust without thickness: graftal draws its "
              "smallest parts one pixel wide, so that they show")
        .with_hint("for thicker parts, name a shape and a size in pixels up to which it is drawn: 'terminal "
                   "sphere below 4'");
}

double nearest_to_eye(const DetailGraph& cut) {
    constexpr double share_of_radius = 1e-5;
    return share_of_radius * std::max(cut.nodes[cut.root].ball.radius, 1e-280);
}

} // namespace graftal
