#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "runtime/trace/model/box_tree.h"

namespace graftal {

struct TraceModel;

/// Up to four triangles of one node that lie in about the same box, as one item of a tree: rays meet them at
/// once. Their edges follow each other; all are similarities, or
/// none is, and none is upright.
struct LeafGroup {
    static constexpr std::uint32_t most = 4;

    std::uint32_t first = 0; ///< edge
    std::uint32_t count = 1;

    /// Whether an item of a tree is more than an edge.
    static bool is(std::uint32_t item) { return (item & mark) != 0 && !(item & BoxNode::inner); }
    /// Requires is(item).
    explicit LeafGroup(std::uint32_t item)
        : first(item & ((1u << shift) - 1)), count(2 + (item >> shift & 3)) {}
    LeafGroup(std::uint32_t first_edge, std::uint32_t edges) : first(first_edge), count(edges) {}

    /// The group as an item of a tree. Requires 1 <= count <= most.
    std::uint32_t item() const { return count < 2 ? first : mark | (count - 2) << shift | first; }

  private:
    static constexpr std::uint32_t mark = 1u << 30;
    static constexpr int shift = 28;
};

/// Items of a tree for these edges, in groups where rays meet these faster; without edges that draw nothing.
/// Requires fewer than 2^28 edges.
std::vector<BoxedItem> grouped_items(const TraceModel& model, std::span<const std::uint32_t> numbers);

/// The triangles of a group in an even model, side by side; by operations of four lanes each is met as it is
/// met alone. The group's last fills the lanes that are left.
struct alignas(64) EvenTriangles {
    /// child_from_parent: the row of the way to their planes first, then the two in these. Of each row the
    /// columns, and the translation.
    Double4 row[3][4];
    Double4 stretch, growth; ///< the edges'
    std::uint32_t first = 0; ///< edge
    std::uint32_t count = 0;
    bool similar = true; ///< the edges are similarities; else none is
};

/// Adds lanes for the groups in an even model's trees. In a part that begins a group, `group` is the number
/// of its triangles. Requires even_parts.
void add_even_triangles(TraceModel& model);

} // namespace graftal
