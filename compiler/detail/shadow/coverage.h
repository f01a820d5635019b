#pragma once

#include <cstdint>

#include "compiler/detail/detail_options.h"
#include "compiler/detail/graph/detail_graph.h"
#include "compiler/detail/graph/symmetry.h"
#include "compiler/support/control.h"

namespace graftal {

/// Fits the proxy of every node to the part that its subtree covers: an ellipsoid about the middle of the
/// subtree's area. Its shadow is as large as the subtree's: over all directions exactly so, and from every
/// side as nearly as an ellipsoid can. Congruent nodes get congruent proxies. Weighs the edges by their
/// visible area, and sets mean colours and finishes by that.
///
/// Shadows are measured on the subtree unfolded to some hundred parts, masters first, so that each node is
/// unfolded down to its masters' proxies: O(graph). A cycle is gone round until its proxies stay as they
/// are, unless there are so many that it would take too long.
/// Nodes that contract too fast for a shadow of their own (dimension <= 2, and no primitive on the way: see
/// `shadowless`) keep the ellipsoid in their box. A culled part is drawn as large as the error, and lines
/// stay visible. Where a full terminal ends a set of dimension 2, it covers about as much at each level: it
/// is drawn as it is, and its node is not marked.
///
/// Draws about `most_bodies` once for each node, and as many again for cycles. Where fewer are allowed,
/// subtrees are unfolded to fewer parts; beyond that, nodes keep the ellipsoid in their box. Returns the
/// number of bodies that it drew: its cost, which the meter counts (null: nobody does).
std::uint64_t fit_proxies(DetailGraph& cut, const Symmetry& symmetry,
                          std::uint64_t most_bodies = PrepareOptions::usual_bodies,
                          WorkMeter* meter = nullptr);

/// Whether the box of a shadowless node is a sheet or a line. Requires fit_proxies().
bool is_flat(const DetailNode& node);

} // namespace graftal
