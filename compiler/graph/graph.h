#pragma once

// The object-instance graph (Hart 1992, section 2): the one representation between the languages and the
// picture.
//
// An object is a primitive or the union of its instances. An instance places its master by an affine map,
// tints it, and may give it a material. Graphs may have cycles: an object that reaches a cycle is called
// *unending*, its meaning is the limit set of the unfolding, which exists if every cycle contracts
// (analysis/contraction.h decides that).
//
// Levels. `--steps n` cuts an unending model after n levels. One level is one instance whose master is
// unending; the root is level 0. This count does not change when equal objects are merged. Where an unending
// object is cut (no level left, or too small to see) it is drawn as
//   1. its terminal, if it has one;
//   2. else, where levels end, its instances of ending masters (its condensation set, its trunk), if it has
//   any;
//   3. else a proxy: an ellipsoid that covers as much of a picture as the object does.
//
// An object whose terminal has a size (`terminal_px`) is drawn as its terminal wherever it measures at most
// so many pixels across: a card or a few triangles in place of a leaf's recursion. Nearer objects are
// unfolded.
//
// An instance may state its levels in place of that count. A zoom's new root does, whose pieces have used up
// the levels on the way to them. So does an object that is taken apart: its *parts*, unending masters of
// instances of no level, are drawn where it is drawn whole, and are never cut themselves.
//
// Combined objects. An object may also be the intersection of its instances, or a difference: the first one
// less all others. An instance of a combined object is an *operand*: a solid, the union of all that is drawn
// of its master, where that lies in space (planes are half spaces, below). Combined objects lie in no cycle,
// and have bounds. Where levels end at one without a terminal, it combines its ending operands, unless its
// first operand does not end.
//
// Tints compose along a path from the root by PathTint, parent in front. The material nearest to the
// primitive wins.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/graph/packed_edges.h"
#include "compiler/graph/primitive.h"
#include "compiler/graph/settings.h"
#include "compiler/support/affine.h"
#include "compiler/support/source.h"
#include "compiler/support/tint.h"

namespace graftal {

using ObjectId = std::uint32_t;

/// One level if the master is unending, else none.
inline constexpr std::uint32_t levels_of_master = UINT32_MAX;

struct Instance {
    ObjectId master = 0;
    Affine parent_from_child;
    Tint tint;
    std::optional<MaterialId> material; ///< nothing: as the parent says
    Span span;
    std::uint32_t levels = levels_of_master; ///< its levels, where it states them ("Levels")
    /// The instance's share of the object's random points (chaos/chances.h), relative to the other
    /// instances; 0: not stated, or none beside others that are. Pictures of surfaces do not depend on it.
    double chance = 0;
};

/// The set that an object makes of its instances.
enum class Combination : std::uint8_t {
    unite,
    intersect, ///< all that lies in each of them
    subtract,  ///< the first one less all others
};

struct Object {
    std::string name;                   ///< unique, an `.inst` name such as `up`, `leaf.llr` or `tip(3)`
    std::optional<Primitive> primitive; ///< then there are no instances and no terminal
    std::vector<Instance> instances;    ///< in the order of the text
    Combination combination = Combination::unite; ///< of the instances
    std::optional<Instance> terminal; ///< drawn in place of the object where recursion is cut; its
                                      ///< master must be ending
    PackedEdges packed;               ///< in place of instances; means what they would, in this order
    double terminal_px = 0;           ///< size on screen from which down the terminal is drawn; 0: that of
                                      ///< what is culled
    Span span;

    /// Not a union ("Combined objects").
    bool is_combined() const { return combination != Combination::unite; }
};

/// Requires for most uses: verify() found nothing (verify.h).
struct Graph {
    std::vector<Object> objects;
    std::vector<Material> materials;
    ObjectId root = 0;
    SceneSettings settings;

    /// Adds an object and returns its id.
    ObjectId add(Object object);
    /// The object for a primitive, made on first use; named after the primitive.
    ObjectId primitive(const Primitive& primitive);
};

/// The edges of the graph, packed ones aside.
std::size_t instance_count(const Graph& graph);

/// The first combined object; none: the number of objects.
ObjectId first_combined(const Graph& graph);

/// All edges of the graph.
std::size_t edge_count(const Graph& graph);

/// Equal structure: the same objects, names, combinations, instances (in order), transforms to the last bit,
/// tints, levels, chances, materials, settings and root, and as many primitives. Packed edges equal the
/// instances that they mean; they name kinds and not objects, so where a graph has some, primitives are not
/// counted. Ids may differ, spans do not count.
bool equal(const Graph& a, const Graph& b);

} // namespace graftal
