#include "compiler/detail/prepare.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "compiler/detail/coverage.h"
#include "compiler/support/check.h"

namespace graftal {

namespace {

/// Comparisons and bodies after which the control is asked: some milliseconds.
constexpr std::uint64_t prepared_a_look = 20'000;

/// Where levels do not end, objects are cut for their size alone: a proxy then stands for all that is left
/// out, and what an object would be drawn by at its last level, a trunk without its twigs, would be too
/// little.
void drop_endings(CutGraph& cut) {
    for (CutNode& node : cut.nodes)
        if (!node.terminal && !node.sealed) node.stop_edges.clear();
}

/// The root counts as a level itself, so that it is never the one that is cut.
void use_up_levels(CutGraph& cut, const std::vector<unsigned>& root_levels) {
    CutNode root = cut.nodes[cut.root];
    for (std::size_t i = 0; i < root.edges.size(); ++i) {
        const std::size_t instance = cut.root_instances[i];
        GRAFTAL_CHECK(instance < root_levels.size(), "cut: root levels and instances differ");
        if (root.edges[i].levels > 0) root.edges[i].levels = root_levels[instance] + 1;
    }
    cut.root = static_cast<NodeId>(cut.nodes.size());
    cut.nodes.push_back(std::move(root));
}

/// Parts that are drawn wider than they are make what holds them wider, too.
void mark_wide(CutGraph& cut) {
    std::vector<std::vector<NodeId>> users(cut.nodes.size());
    std::vector<NodeId> wide;
    for (NodeId id = 0; id < cut.nodes.size(); ++id) {
        CutNode& node = cut.nodes[id];
        for (const std::vector<CutEdge>* edges : {&node.edges, &node.stop_edges})
            for (const CutEdge& edge : *edges)
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

PreparedCut prepare_cut(const Graph& graph, const Components& components,
                        const std::vector<ObjectBounds>& bounds, const PrepareOptions& options,
                        const Control& control) {
    WorkMeter meter(control, "prepare", prepared_a_look);
    PreparedCut prepared;
    CutGraph& cut = prepared.cut = build_cut_graph(graph, components, bounds);
    if (!options.steps) drop_endings(cut);
    if (!options.root_levels.empty()) use_up_levels(cut, options.root_levels);
    split_into_halves(cut);
    prepared.symmetry = find_symmetry(cut);
    meter.add(prepared.symmetry.comparisons);
    if (options.culls || (components.unending[graph.root] && options.steps))
        fit_proxies(cut, prepared.symmetry, &meter);
    mark_wide(cut);
    mark_solid(cut);
    prepared.bounds = bounds[graph.root].box;
    prepared.instances = instance_count(graph);
    if (options.steps) prepared.root_steps = *options.steps + (options.root_levels.empty() ? 0 : 1);
    return prepared;
}

bool refuse_endless(const Graph& graph, const Components& components, const DetailOptions& options,
                    Diagnostics& diagnostics) {
    if (!components.unending[graph.root] || options.steps || options.culls()) return false;
    diagnostics
        .error(graph.objects[graph.root].span,
               "the recursion has no end, and nothing says how deep to draw it")
        .with_hint("give a depth with --steps N, or a size in pixels with --error");
    return true;
}

void note_shadowless(const CutGraph& cut, const Graph& graph, Diagnostics& diagnostics) {
    const auto widens_proxy = [&](const CutEdge& edge) { // the root itself is always drawn whole
        const CutNode& node = cut.nodes[edge.child];
        return node.shadowless && node.cullable && !node.terminal;
    };
    if (std::ranges::none_of(
            cut.nodes, [&](const CutNode& user) { return std::ranges::any_of(user.edges, widens_proxy); }))
        return;
    diagnostics
        .note(graph.objects[graph.root].span, "some set here has no area (its dimension is at most 2): its "
                                              "smallest parts are drawn a pixel wide")
        .with_hint(
            "name what they look like, and up to how many pixels they look so: 'terminal sphere below 4'");
}

double nearest_to_eye(const CutGraph& cut) {
    constexpr double share_of_radius = 1e-5;
    return share_of_radius * std::max(cut.nodes[cut.root].ball.radius, 1e-280);
}

} // namespace graftal
