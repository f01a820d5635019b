#pragma once

#include <cstdint>

namespace graftal {

/// The one rule that ends recursion, whoever unfolds: no level is left, or what may be culled is small
/// enough. Primitives and what holds planes never end by it. `Node`: DetailNode, or the tracer's.
template<typename Node> bool ends_recursion(const Node& node, std::uint32_t steps, bool small) {
    return (node.unending && steps == 0) || (node.cullable && small);
}

} // namespace graftal
