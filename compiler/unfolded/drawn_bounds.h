#pragma once

#include <cstdint>
#include <vector>

#include "compiler/analysis/bounding.h"
#include "compiler/detail/graph/detail_graph.h"
#include "compiler/support/bounds.h"
#include "compiler/support/control.h"

namespace graftal {

/// Boxes of all that may be drawn of a prepared graph, however deep it is cut: besides the limit set, the
/// terminals and the proxies. Without what thin parts are widened by (least_width.h): that depends on the
/// view.
struct DrawnBounds {
    std::vector<Box> node;                   ///< in the node's frame; empty: nothing but planes
    std::vector<std::vector<Box>> edge;      ///< by node and edge: the child, in the node's frame
    std::vector<std::vector<Box>> stop_edge; ///< likewise
    std::uint64_t pieces = 0;                ///< looked at to find them (bound_boxes())
};

/// The place of a node's own frame in the frame that the graph gives it: what the node draws, in `box`, fills
/// the cube [-1, 1]^3 of its own or nearly so. Scaled by a power of two, so that maps keep their digits.
Affine graph_from_frame(const DetailNode& node, const Box& box);

/// True if the box of the image is the image of the box.
bool keeps_axes(const Mat3& m);

/// The box of an image of a primitive, exact. Not for planes.
Box box_of_image(const Primitive& primitive, const Affine& place);
/// box_of_image(), but somewhat larger where that is faster to find.
Box box_about_image(const Primitive& primitive, const Affine& place);

/// Requires a graph whose cycles contract. O(graph), and about as many pieces as are allowed: fewer make
/// larger boxes.
DrawnBounds drawn_bounds(const DetailGraph& cut, std::uint64_t most_pieces = graftal::most_pieces,
                         const Control& control = no_control());

} // namespace graftal
