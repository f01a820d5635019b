#pragma once

// Runs (graph/run.h) in the cut: an object that has one becomes a tree of nodes over its ranges. The lowest
// nodes, the cells, hold a range of the run in place of edges. Their edges are made one by one where they
// are looked at.

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "compiler/analysis/run_bounds.h"
#include "compiler/detail/graph/cut_graph.h"

namespace graftal {

/// A run and what its items lead to.
struct RunSource {
    std::shared_ptr<const Run> run;
    std::vector<std::optional<MaterialId>> materials; ///< by colour
    std::array<NodeId, RunShape::count> child{};      ///< by RunShape::index()
};

/// A range of a run.
struct RunCell {
    std::shared_ptr<const RunSource> source;
    std::size_t first = 0, count = 0;
    Box box;
    /// Its parts by what they weigh: of one shape, and of one size within a quarter of an octave.
    struct Alike {
        RunShape shape;
        std::int32_t quarter_octave = 0; ///< of the stretch of their edges
        std::uint32_t count = 0;
    };
    std::vector<Alike> alike;
    double flattest = 1; ///< least length of any part along an axis, as a share of the largest
};

/// The level of RunBounds whose ranges become cells, if there are enough items.
inline constexpr std::size_t cell_level = 1;

/// The edge to the primitive of an item, or to the ball at its end.
CutEdge edge_to_body(const RunSource& source, const RunItem& item);
CutEdge edge_to_ball(const RunSource& source, const RunItem& item);

/// The mean over all directions of an item's shadow, its ball's with it: a quarter of the surface of a convex
/// body. Of a cylinder half of whose balls are seen.
double mean_shadow(const RunItem& item);

/// Calls `visit` on the edges that a visit of the node follows, in their order (followed_edges()).
template<typename Visit> void for_each_edge(const CutNode& node, bool cut, const Visit& visit) {
    if (!node.cell || cut) {
        for (const CutEdge& edge : followed_edges(node, cut))
            visit(edge);
        return;
    }
    const RunCell& cell = *node.cell;
    for (std::size_t i = cell.first; i < cell.first + cell.count; ++i) {
        const RunItem& item = (*cell.source->run)[i];
        visit(edge_to_body(*cell.source, item));
        if (item.ball) visit(edge_to_ball(*cell.source, item));
    }
}

/// Number of edges that for_each_edge() visits.
std::size_t edge_count(const CutNode& node, bool cut);

/// Fills in `node`, which has everything else of its object but edges, ball and proxy, and adds the nodes
/// below it. `source` must know all children that are met.
void add_run_nodes(CutGraph& cut, CutNode& node, const std::shared_ptr<const RunSource>& source,
                   const RunBounds& bounds);

} // namespace graftal
