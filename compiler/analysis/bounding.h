#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "compiler/analysis/contraction.h"
#include "compiler/graph/components.h"
#include "compiler/graph/graph.h"
#include "compiler/support/bounds.h"
#include "compiler/support/control.h"

namespace graftal {

class RunBounds;

/// Outer bounds of an object's limit set, in the object's own frame.
struct ObjectBounds {
    Box box;   ///< every face touches the set to within 1e-10 of its size where effort allows; a combined
               ///< object may be smaller: bounding_instances()
    Ball ball; ///< holds the set; its radius within a few per cent of the least where effort allows
    bool unbounded = false;               ///< holds a plane; box and ball are then of the rest
    std::shared_ptr<const RunBounds> run; ///< of an object that has one: of its ranges (run_bounds.h)
};

/// The box of a primitive (exact), and a small ball (PrimitiveTraits). A plane has neither.
ObjectBounds primitive_bounds(const Primitive& primitive);

/// The instances whose union bounds the object: of a difference the first one. None of an intersection, which
/// its box bounds.
inline std::span<const Instance> bounding_instances(const Object& object) {
    if (object.combination == Combination::intersect) return {};
    return std::span(object.instances).first(object.is_combined() ? 1 : object.instances.size());
}

/// Pieces that the search for the faces of all boxes may look at, and the fewest that it takes.
inline constexpr std::uint64_t most_pieces = 8'000'000;
std::uint64_t fewest_pieces(const Graph& graph, const Components& components);

/// Bounds by object, masters before their users: ending objects from exact support functions of what they
/// hold; unending ones by best-first support functions over balls that are first made invariant in the
/// certificate's metric. Terminals do not count: the bounds are those of the limit set. Requires a
/// contraction that is proved or acyclic. `pieces`: how many the search for box faces has looked at, which
/// the control follows; it is asked after each face.
std::vector<ObjectBounds> bound_objects(const Graph& graph, const Components& components,
                                        const Contraction& contraction, const Control& control = no_control(),
                                        std::uint64_t* pieces = nullptr);

/// The boxes of bound_objects(), with the same requirements. Faster: it looks for no ball of an object that
/// no other instances. Takes about `most` pieces; `pieces` gets their number.
std::vector<Box> bound_boxes(const Graph& graph, const Components& components, const Contraction& contraction,
                             std::uint64_t most, std::uint64_t& pieces, const Control& control);

} // namespace graftal
