#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec4.hpp>

#include "compiler/support/bounds.h"

namespace graftal {

/// An entry of the kernel's trees of boxes, and where it lies.
struct FlatItem {
    Box box;
    std::uint32_t entry = 0;
};

/// Builds a tree of four boxes a node over the items by the surface area heuristic, at the end of `boxes`.
/// Boxes are rounded outwards by what rays in single precision may be off. Items without an end
/// (flat_endless) come before the tree: rays meet them first. Returns the number of its root, the entry
/// itself where there is one item, or `none` where there are none. O(n log^2 n); reorders the items.
std::uint32_t build_flat_boxes(std::vector<FlatItem>& items, std::vector<glm::vec4>& boxes);

} // namespace graftal
