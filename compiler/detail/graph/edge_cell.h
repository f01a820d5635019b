#pragma once

// Packed edges (graph/packed_edges.h) in the cut: an object that has them becomes a tree of nodes over ranges
// of their items. The lowest nodes hold a cell in place of edges.

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "compiler/analysis/run_bounds.h"
#include "compiler/detail/graph/detail_graph.h"

namespace graftal {

/// Packed edges and what they lead to.
struct CellSource : PackedEdges {
    std::array<NodeId, RunShape::count> child{}; ///< by RunShape::index()
};

/// An edge of a cell.
struct CellEdge : DetailEdge {
    RunShape shape;
    std::uint16_t colour = 0;
};

/// The edge to the primitive of an item, or to the ball at its end.
CellEdge edge_to_body(const CellSource& source, const RunItem& item);
CellEdge edge_to_ball(const CellSource& source, const RunItem& item);

/// The mean over all directions of an item's shadow, its ball's with it: a quarter of the surface of a convex
/// body. A cylinder with a ball counts as if half a ball lay at each end.
double mean_shadow(const RunItem& item);

/// Edges to the parts of a range of items, each made where it is looked at.
struct EdgeCell {
    std::shared_ptr<const CellSource> source;
    std::size_t first = 0, count = 0; ///< items
    Box box;
    /// Its parts by what they weigh: of one shape, and of one size within a quarter of an octave.
    struct Alike {
        RunShape shape;
        std::int32_t quarter_octave = 0; ///< of the stretch of their edges
        std::uint32_t count = 0;
    };
    std::vector<Alike> alike;
    double flattest = 1; ///< least length of any part along an axis, as a share of the largest

    std::size_t size() const; ///< edges

    /// Calls `visit` on each CellEdge, in their order.
    template<typename Visit> void for_each(const Visit& visit) const {
        for (std::size_t i = first; i < first + count; ++i) {
            const RunItem& item = (*source->run)[i];
            visit(edge_to_body(*source, item));
            if (item.ball) visit(edge_to_ball(*source, item));
        }
    }
    /// Calls `visit(material, mean shadow)` on the items.
    template<typename Visit> void for_each_shadow(const Visit& visit) const {
        for (std::size_t i = first; i < first + count; ++i) {
            const RunItem& item = (*source->run)[i];
            visit(source->materials[item.colour], mean_shadow(item));
        }
    }
};

/// The level of RunBounds whose ranges become cells, if there are enough items.
inline constexpr std::size_t cell_level = 1;

/// Calls `visit` on the edges that a visit of the node follows, in their order (followed_edges()).
template<typename Visit> void for_each_edge(const DetailNode& node, bool cut, const Visit& visit) {
    if (node.cell && !cut) return node.cell->for_each(visit);
    for (const DetailEdge& edge : followed_edges(node, cut))
        visit(edge);
}

/// Number of edges that for_each_edge() visits.
std::size_t edge_count(const DetailNode& node, bool cut);

/// Fills in `node`, which has everything else of its object but edges, ball and proxy, and adds the nodes
/// below it. `node_of` gives the node of a primitive.
void add_cells(DetailGraph& cut, DetailNode& node, const PackedEdges& edges, const RunBounds& bounds,
               const std::function<NodeId(const Primitive&)>& node_of);

} // namespace graftal
