#pragma once

#include <optional>
#include <vector>

#include "compiler/graph/components.h"
#include "compiler/graph/graph.h"

namespace graftal {

/// A graph that is nothing but an iterated function system: A = C u union of w_j(A).
struct OrdinaryIfs {
    std::vector<Instance> maps;         ///< the w_j; their masters do not matter
    std::vector<Instance> condensation; ///< the parts of C
};

/// The system that the root is, if it is one: an object that contains itself, or several that each contain
/// all of them under one map. A `.rifs` where every map may follow every map is the latter. Nothing for
/// other graphs.
std::optional<OrdinaryIfs> ordinary_ifs(const Graph& graph, const Components& components);

/// A flat map, x -> linear x + translation in the plane z = 0, and the norm in which maps are to contract.
struct PlaneNorm {
    Mat3 metric{1.0};     ///< L of |L x|; only x and y count
    double condition = 1; ///< longest over shortest unit vector, in lengths of the plane
    double rate = 1;      ///< of the map that contracts least, in this norm
};

/// The norm in which the maps contract: the plane's own if they do in that, else one that was found for them.
/// The rate is 1 or more if there is none. Requires flat maps.
PlaneNorm contracting_norm(const std::vector<Instance>& maps);

/// Whether the map takes the plane z = 0 into itself.
bool is_flat(const Affine& map);

} // namespace graftal
