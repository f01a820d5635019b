#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/graph/path.h"
#include "compiler/support/bounds.h"

namespace graftal {

using NodeId = std::uint32_t;

struct DetailEdge {
    NodeId child = 0;
    Affine node_from_child;
    PathTint tint;
    std::optional<MaterialId> material;
    unsigned levels = 0;       ///< 1 if the child is unending (graph.h, "Levels")
    double stretch = 1;        ///< norm of the linear part
    double volume_stretch = 1; ///< cube root of the determinant; the stretch if that is zero
    bool similarity = false;   ///< then a path's norm is the product of its stretches
    double weight = 1;         ///< in the node's mean colour
};

struct EdgeCell;

/// An object as the cut sees it.
struct DetailNode {
    std::string name;
    std::optional<Primitive> primitive;
    Combination combination = Combination::unite; ///< of the edges, and of the stop edges except a terminal
    std::vector<DetailEdge> edges;
    std::vector<DetailEdge>
        stop_edges; ///< drawn in place of the edges where the node is cut; if empty: proxy
    std::shared_ptr<const EdgeCell> cell; ///< in place of edges: see for_each_edge() (edge_cell.h)
    bool terminal = false;                ///< stop_edges holds the terminal, not the ending instances
    double terminal_px = 0;               ///< the object's (graph.h)
    bool unending = false;
    bool solid = false;      ///< some way leads to a primitive
    bool unbounded = false;  ///< is a plane or holds one: always expanded into placements
    bool sealed = false;     ///< leads through a singular map: never expanded, POV-Ray could not place it
    bool cullable = true;    ///< worth a proxy; a handful of primitives is drawn as it is
    bool textured = false;   ///< some material within it has a picture
    bool shadowless = false; ///< its limit covers no area: it looks the fainter the deeper it is unfolded
    bool widens = false;     ///< some part of it may be drawn wider than it is (least_width.h)
    Ball ball;
    Affine node_from_proxy; ///< places the unit sphere: the ellipsoid in the node's box, until fit_proxies()
    MeanColour mean;        ///< its limit's, from afar
    std::optional<MeanColour> lit;    ///< its proxy's colour in place of `mean`: see set_lit_colours()
    std::optional<MaterialId> finish; ///< the most visible one in its limit; none: that it inherits

    bool is_combined() const { return combination != Combination::unite; }
};

/// A graph after the passes for detail, with what unfolding it asks for at every edge.
struct DetailGraph {
    std::vector<DetailNode> nodes;
    std::vector<Material> materials;
    NodeId root = 0;
    bool tinted = false;     ///< some instance has a tint
    bool contractive = true; ///< every edge within a cycle has stretch < 1: products of stretches end
};

/// The colour of the stand-in for a node.
inline const MeanColour& colour_of_proxy(const DetailNode& node) {
    return node.lit ? *node.lit : node.mean;
}

/// The change of looks along an edge of a node. A terminal takes on the mean colour of the node that is cut.
template<typename Edge>
LookStep look_step(const DetailGraph& cut, const DetailNode& node, bool is_cut, const Edge& edge) {
    return look_step(edge, is_cut && node.terminal ? &node.mean : nullptr, cut.materials);
}

/// Every node once, and after the nodes it leads to except those that lead back to it.
std::vector<NodeId> masters_first(const DetailGraph& cut);

/// Sets the mean colours anew, by the weights of the edges. Exact for ending nodes, converging geometrically
/// for the others.
void set_mean_colours(DetailGraph& cut);

/// Sets the finish that what stands for each node shows, by the weights of the edges: of its materials the
/// one that is seen most, if more of it is seen than of what inherits. None for pictures, which wrap round
/// single primitives, and for what is transparent, since one large lens is not what many small ones are. Sets
/// none in graphs that are too large for it. Keeps those of nodes without edges.
void set_finishes(DetailGraph& cut);

/// The material of which most is seen, as above. `shares`: by material, and of what inherits.
std::optional<MaterialId> most_seen(std::span<const double> shares, const std::vector<Material>& materials);

/// Sets what is solid. O(graph).
void mark_solid(DetailGraph& cut);

/// The edges that a visit follows: all of them, or those of a cut node. None of a cell, which has others.
inline const std::vector<DetailEdge>& followed_edges(const DetailNode& node, bool cut) {
    return cut ? node.stop_edges : node.edges;
}

} // namespace graftal
