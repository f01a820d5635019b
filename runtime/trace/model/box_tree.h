#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "compiler/support/bounds.h"
#include "compiler/support/control.h"
#include "runtime/trace/model/lanes.h"

namespace graftal {

/// Eight boxes side by side, each of an item or of another node. Lanes that are not used hold no
/// numbers: no ray meets them.
struct alignas(64) BoxNode {
    static constexpr std::uint32_t inner = 1u << 31;  ///< marks the number of a node among those of items
    static constexpr std::uint32_t packed = 1u << 30; ///< and this, besides, that of a PackedNode

    Float8 side[2][3]; ///< the lower and the upper, by axis
    std::array<std::uint32_t, 8> entry{};
};

/// An item of a tree and where it lies.
struct BoxedItem {
    std::array<float, 3> lower{}, upper{};
    std::uint32_t item = 0; ///< less than BoxNode::inner

    /// Rounds outwards, by what rays in single precision may be off as well, in a frame that the tree fills.
    BoxedItem(const Box& box, std::uint32_t item);
};

/// Eight items that follow each other closely in number, in less than half the room: their boxes in bytes,
/// outwards, as shares of the box of all. A lane that is not used repeats the one before it.
struct PackedNode {
    std::array<float, 3> origin{}, step{};                            ///< a side lies at origin + byte * step
    std::array<std::array<std::array<std::uint8_t, 8>, 3>, 2> side{}; ///< BoxNode's sides
    std::uint32_t first = 0;                                          ///< an item is this and its offset
    std::uint8_t count = 0;
    std::array<std::uint8_t, 8> offset{};
};

inline constexpr std::uint32_t no_tree = std::numeric_limits<std::uint32_t>::max();

/// Builds a tree over the items by the surface area heuristic, at the end of `nodes`; returns the number of
/// its root, or no_tree if there are no items. O(n log n), and no deeper than 64 levels. Reorders the items.
/// The flag ends it by Cancelled.
std::uint32_t build_box_tree(std::vector<BoxedItem>& items, std::vector<BoxNode>& nodes,
                             const CancelFlag& cancel = {});

/// Builds a tree with packed nodes at the end of `packed`, as few as can be, and other nodes above them.
/// Requires numbers of items that are less than 256 apart.
std::uint32_t build_packed_tree(std::vector<BoxedItem>& items, std::vector<BoxNode>& nodes,
                                std::vector<PackedNode>& packed, const CancelFlag& cancel = {});

} // namespace graftal
