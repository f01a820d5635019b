#pragma once

#include <cstdint>
#include <vector>

#include "runtime/trace/lanes.h"

namespace graftal {

struct TraceModel;

/// What rays ask of an edge on their short way (traversal_even.h), close together: thousands of parts then
/// fit into the caches.
struct alignas(64) EvenPart {
    enum class Kind : std::uint8_t {
        node,
        cube, ///< upright, as its parent is
        triangle,
        primitive, ///< any other
    };

    Double4 shift;  ///< translation of child_from_parent
    Double4 offset; ///< and of parent_from_child
    double shrink;  ///< entry of the first; `stretch` and `growth` may differ by a rounding
    double entry;   ///< and of the second
    double stretch, growth;
    double turns; ///< TraceEdge's
    std::uint32_t child, levels;
    Kind kind;
    bool upright; ///< TraceEdge's
};

/// One for each edge of an even model.
std::vector<EvenPart> even_parts(const TraceModel& model);

} // namespace graftal
