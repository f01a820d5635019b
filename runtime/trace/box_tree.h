#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "compiler/support/bounds.h"
#include "runtime/trace/lanes.h"

namespace graftal {

/// Eight boxes side by side, each of an item or of another node. Lanes that are not used hold no
/// numbers: no ray meets them.
struct BoxNode {
    static constexpr std::uint32_t inner = 1u << 31; ///< marks the number of a node among those of items

    Float8 side[2][3]; ///< the lower and the upper, by axis
    std::array<std::uint32_t, 8> entry{};
};

/// An item of a tree and where it lies.
struct BoxedItem {
    std::array<float, 3> lower{}, upper{};
    std::uint32_t item = 0; ///< less than BoxNode::inner

    /// Rounds outwards, by what rays in single precision may be off as well. `extent`: of the coordinates in
    /// the tree.
    BoxedItem(const Box& box, double extent, std::uint32_t item);
};

inline constexpr std::uint32_t no_tree = std::numeric_limits<std::uint32_t>::max();

/// Builds a tree over the items by the surface area heuristic, at the end of `nodes`; returns the number of
/// its root, or no_tree if there are no items. O(n log n), and no deeper than 64 levels. Reorders the items.
std::uint32_t build_box_tree(std::vector<BoxedItem>& items, std::vector<BoxNode>& nodes);

} // namespace graftal
