#include "runtime/trace/model/box_tree.h"

#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace graftal {
namespace {

constexpr std::uint32_t first_number = 70'000; // as of a range somewhere in a run

std::vector<BoxedItem> items(std::size_t count, std::mt19937& random) {
    std::uniform_real_distribution<double> place(-1, 1), size(0, 0.1);
    std::vector<BoxedItem> result;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 low(place(random), place(random), i % 5 == 0 ? 0.25 : place(random));
        const Vec3 more(size(random), size(random), i % 5 == 0 ? 0 : size(random));
        result.emplace_back(Box{low, low + more}, first_number + static_cast<std::uint32_t>(i));
    }
    return result;
}

/// Looks at all items under an entry, and whether they lie within the box that leads to them.
class PackedWalk {
  public:
    PackedWalk(const std::vector<BoxedItem>& items, const std::vector<BoxNode>& nodes,
               const std::vector<PackedNode>& packed)
        : items_(items), nodes_(nodes), packed_(packed), met_(items.size()) {}

    void run(std::uint32_t entry) {
        if (entry & BoxNode::packed) return run_packed(packed_.at(entry & ~BoxNode::packed));
        const BoxNode& node = nodes_.at(entry);
        for (std::size_t lane = 0; lane < 8; ++lane) {
            if (!(node.side[0][0][lane] <= node.side[1][0][lane])) continue;
            ASSERT_TRUE(node.entry[lane] & BoxNode::inner);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                box_[0][axis] = node.side[0][axis][lane];
                box_[1][axis] = node.side[1][axis][lane];
            }
            run(node.entry[lane] & ~BoxNode::inner);
        }
    }

    const std::vector<int>& met() const { return met_; }

  private:
    void run_packed(const PackedNode& node) {
        for (std::size_t lane = 0; lane < node.count; ++lane) {
            const std::size_t i = node.first + node.offset[lane] - first_number;
            ++met_.at(i);
            for (const BoxedItem& item : items_) {
                if (item.item != first_number + i) continue;
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    EXPECT_LE(side(node, 0, axis, lane), item.lower[axis]);
                    EXPECT_GE(side(node, 1, axis, lane), item.upper[axis]);
                    if (packed_.size() == 1) continue;
                    EXPECT_LE(box_[0][axis], item.lower[axis]);
                    EXPECT_GE(box_[1][axis], item.upper[axis]);
                }
            }
        }
    }

    static float side(const PackedNode& node, std::size_t side, std::size_t axis, std::size_t lane) {
        return node.origin[axis] + static_cast<float>(node.side[side][axis][lane]) * node.step[axis];
    }

    const std::vector<BoxedItem>& items_;
    const std::vector<BoxNode>& nodes_;
    const std::vector<PackedNode>& packed_;
    std::array<std::array<float, 3>, 2> box_{};
    std::vector<int> met_;
};

TEST(BoxTree, packedItemsLieInTheirBoxes) {
    std::mt19937 random(7);
    for (const std::size_t count : {1u, 2u, 7u, 8u, 9u, 16u, 63u, 64u, 65u, 200u, 256u}) {
        std::vector<BoxedItem> boxed = items(count, random);
        std::vector<BoxNode> nodes;
        std::vector<PackedNode> packed;
        const std::uint32_t root = build_packed_tree(boxed, nodes, packed);
        PackedWalk walk(boxed, nodes, packed);
        walk.run(root);
        EXPECT_EQ(walk.met(), std::vector<int>(count, 1)) << count;
        EXPECT_EQ(packed.size(), (count + 7) / 8) << count;
    }
}

/// Of a run's ten million items each byte counts.
TEST(BoxTree, packedItemsTakeSixteenBytes) {
    std::mt19937 random(11);
    std::vector<BoxedItem> boxed = items(256, random);
    std::vector<BoxNode> nodes;
    std::vector<PackedNode> packed;
    build_packed_tree(boxed, nodes, packed);
    const std::size_t bytes = nodes.size() * sizeof(BoxNode) + packed.size() * sizeof(PackedNode);
    EXPECT_LE(bytes, 16 * boxed.size());
}

/// A float cannot hold where some boxes end, and has no middle for them.
TEST(BoxTree, boxesWithoutEndsAreSorted) {
    std::mt19937 random(13);
    std::vector<BoxedItem> boxed = items(40, random);
    for (std::uint32_t i = 0; i < 20; ++i)
        boxed.emplace_back(Box{Vec3(i % 3 ? -1e300 : 1e38), Vec3(1e300)}, first_number + 40 + i);
    std::vector<BoxNode> nodes;
    ASSERT_NE(build_box_tree(boxed, nodes), no_tree);
    std::vector<int> met(60);
    for (const BoxNode& node : nodes)
        for (std::size_t lane = 0; lane < 8; ++lane)
            if (node.side[0][0][lane] <= node.side[1][0][lane] && !(node.entry[lane] & BoxNode::inner))
                ++met.at(node.entry[lane] - first_number);
    EXPECT_EQ(met, std::vector<int>(60, 1));
}

TEST(BoxTree, nothingHasNoTree) {
    std::vector<BoxedItem> none;
    std::vector<BoxNode> nodes;
    std::vector<PackedNode> packed;
    EXPECT_EQ(build_packed_tree(none, nodes, packed), no_tree);
}

} // namespace
} // namespace graftal
