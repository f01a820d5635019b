#pragma once

#include <cstdint>

#include "runtime/trace/model/lanes.h"

namespace graftal {

struct TraceModel;

/// Data of an edge that rays need on their short way (traverse/even.h), in one line of the processor's
/// caches: thousands of parts then fit into these.
struct alignas(64) EvenPart {
    enum class Kind : std::uint8_t {
        node,
        cube, ///< upright, as its parent is
        triangle,
        primitive, ///< any other
    };

    /// Translation of child_from_parent and, in the last lane, its scale; `stretch` and `growth` may differ
    /// from that by a rounding. What is computed with it has nothing of use in its last lane.
    Double4 shift;
    double stretch, growth;
    std::uint32_t child, levels;
    Kind kind;
    bool upright;            ///< TraceEdge's
    bool within = false;     ///< the child's reach is within that of the node
    std::uint32_t group = 0; ///< TraceModel::even_triangles, where it begins some

    double shrink() const { return shift[3]; }
};

/// Translation of parent_from_child, and its scale in the last lane.
struct EvenOffset {
    Double4 offset;
};

/// Adds both for each edge of an even model. Requires its trees.
void add_even_parts(TraceModel& model);

} // namespace graftal
