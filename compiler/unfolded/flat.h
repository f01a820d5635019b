#pragma once

// A graph as arrays of plain numbers, for engines that follow no pointers and have no doubles, such as those
// of GPUs. Cycles stay cycles: a walk counts the levels that it has left, so that memory does not depend on
// them. Each node has a frame of its own, which what it draws fills (graph_from_frame()).

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "compiler/graph/path.h"
#include "compiler/unfolded/drawn_bounds.h"
#include "compiler/unfolded/layers.h"

namespace graftal {

/// A number in two floats, to 48 bits: deep zooms need more than one.
struct FloatPair {
    float high = 0, low = 0;

    FloatPair() = default;
    explicit FloatPair(double value)
        : high(static_cast<float>(value)), low(static_cast<float>(value - static_cast<double>(high))) {}
    double value() const { return static_cast<double>(high) + static_cast<double>(low); }
};

inline constexpr std::uint32_t flat_none = UINT32_MAX;
/// Half the side of the box of what has no end.
inline constexpr float flat_endless = 1e30f;

struct FlatEdge {
    std::uint32_t child = 0;
    std::uint32_t levels = 0; ///< those that a walk has left get fewer by it
    std::uint32_t material = flat_none;
    float stretch = 1;         ///< norm of the map's linear part, between the frames
    float turns = 1;           ///< of a primitive: length_in_turns() of its map
    std::uint32_t crushes = 0; ///< 1: the map is singular, or nearly (flattest_placement)
    Paint tint;
    /// Linear part by columns: of child_from_parent, of points from the child's origin; of what is
    /// crushed, of parent_from_child.
    std::array<FloatPair, 9> linear;
    std::array<FloatPair, 3> origin; ///< of the child, in the parent's frame
    std::array<float, 6>
        box; ///< holds all that the child draws, in the parent's frame; flat_endless or more if it has no end
};

/// FlatEdge::linear.
Mat3 linear_of(const FlatEdge& edge);
Affine parent_from_child(const FlatEdge& edge);
/// A box as edges have it, rounded outwards; and that of an edge.
std::array<float, 6> floats_of(const Box& box);
Box box_of(const FlatEdge& edge);

struct FlatNode {
    std::uint32_t first_edge = 0;
    std::uint32_t edge_count = 0;
    std::uint32_t stop_edge_count = 0;   ///< those after: followed where it is cut; none: its proxy is drawn
    std::uint32_t primitive = flat_none; ///< of FlatGraph::primitives; then it has no edges
    std::uint32_t unending = 0;    ///< 1: cut where no level is left; planes and what holds them never are
    std::uint32_t faint = 0;       ///< DetailNode::shadowless
    std::uint32_t widens = 0;      ///< 1: holds what is faint or crushed, and drawn wider than it is
    std::uint32_t terminal = 0;    ///< 1: below the stop edges, what names no material inherits `mean`
    std::array<float, 3> centre{}; ///< of the ball that decides how large it is, in its frame
    float diameter = 0;            ///< likewise
    float reach = 0;               ///< from there to all that it draws
    float cut_detail = 0;          ///< detail of the diameter from which down it is cut; 0: never
    std::array<float, 12> frame_from_proxy{}; ///< places the unit sphere: by columns, the translation last
    Paint mean, proxy;                        ///< colours from afar
    std::uint32_t finish = flat_none;         ///< material of the proxy; none: that it inherits
};

/// The map that places a proxy.
Affine frame_from_proxy(const FlatNode& node);

struct FlatGraph {
    std::vector<FlatNode> nodes; ///< by number of the layers
    std::vector<FlatEdge> edges;
    std::vector<Primitive> primitives; ///< none twice
    NodeId root = 0;
    Affine world_from_root; ///< from the root's frame
};

/// Nothing where the graph is no input for such an engine: it has more than `most_edges` edges, or a singular
/// map places what has no end. `error_px`: Projection::error_px(). O(edges), those of cells
/// spelt out.
std::optional<FlatGraph> flat_graph(const LayeredGraph& layers, const DrawnBounds& bounds, double error_px,
                                    std::size_t most_edges);

} // namespace graftal
