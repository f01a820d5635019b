#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "compiler/analysis/bounding.h"
#include "compiler/analysis/contraction.h"
#include "compiler/graph/graph.h"

namespace graftal {

/// Where the objects of a graph are after a pass, so that what is known of them can be carried over.
struct Renumbering {
    static constexpr ObjectId dropped = UINT32_MAX;

    /// Attributes that a pass took out of an object and gave to the instances that use it.
    struct Taken {
        Affine parent_from_rest;
        Tint tint;
        std::optional<MaterialId> material; ///< of the new graph
    };

    std::vector<ObjectId> now;    ///< by old object: the new one that draws it, or `dropped`
    std::vector<ObjectId> origin; ///< by new object: the old one that it was, or was a part of
    std::vector<Taken> taken;     ///< by old object; empty if nothing was taken out of any
    /// Old objects, as they lie, by the new object that is their union and not its origin any more.
    std::map<ObjectId, std::vector<ObjectId>> united;

    /// Every object is what it was. Requires that the graphs have equally many.
    static Renumbering identity(std::size_t objects);
};

/// A graph that a pass has made of another.
struct Rewritten {
    Graph graph;
    Renumbering renumbering;
};

/// An instance of the new graph that draws what this one of an old object drew. Requires a pass that takes
/// nothing out of objects, and apart.
GraphStep followed(const Renumbering& renumbering, const GraphStep& step, const Object& before,
                   const Graph& after);

/// The bounds of the new objects, given those of the old ones.
std::vector<ObjectBounds> carried_over(const Renumbering& renumbering,
                                       const std::vector<ObjectBounds>& bounds);

} // namespace graftal
