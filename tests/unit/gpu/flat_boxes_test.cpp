#include "runtime/gpu/flat_boxes.h"

#include <bit>
#include <functional>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "runtime/gpu/flat_model.h"

namespace graftal {
namespace {

/// The number of times that each entry is met below a node, whose boxes must lie in `outer`; or at a single
/// entry.
void walk(const std::vector<glm::vec4>& boxes, std::uint32_t node, const Box& outer, int depth,
          std::map<std::uint32_t, int>& met, int& deepest) {
    deepest = std::max(deepest, depth);
    if ((node & ~ENTRY_NUMBER) != 0) {
        ++met[node];
        return;
    }
    for (std::uint32_t i = 0; i < 4; ++i) {
        const glm::vec4& low = boxes[node * BOX_SIZE + 2 * i];
        const glm::vec4& high = boxes[node * BOX_SIZE + 2 * i + 1];
        const auto entry = std::bit_cast<std::uint32_t>(low.w);
        if (entry == NONE) continue;
        const Box box{Vec3(low), Vec3(high)};
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_LE(outer.min[axis], box.min[axis] + 1e-5);
            EXPECT_GE(outer.max[axis], box.max[axis] - 1e-5);
        }
        if ((entry & ~ENTRY_NUMBER) == 0)
            walk(boxes, entry, box, depth + 1, met, deepest);
        else
            ++met[entry];
    }
}

std::vector<FlatItem> random_items(std::size_t count, double spread) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> place(-1, 1);
    std::vector<FlatItem> items;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 at = spread * Vec3(place(random), place(random), place(random));
        items.push_back({{at - 0.1, at + 0.1}, ENTRY_PART | static_cast<std::uint32_t>(i)});
    }
    return items;
}

TEST(FlatBoxes, HoldEachItemOnce) {
    for (const std::size_t count : {1, 2, 4, 5, 17, 1000}) {
        std::vector<FlatItem> items = random_items(count, 1);
        std::vector<glm::vec4> boxes;
        const std::uint32_t root = build_flat_boxes(items, boxes);
        std::map<std::uint32_t, int> met;
        int deepest = 0;
        walk(boxes, root, {Vec3(-2.0), Vec3(2.0)}, 1, met, deepest);
        EXPECT_EQ(met.size(), count);
        for (const auto& [entry, times] : met)
            EXPECT_EQ(times, 1) << entry;
        EXPECT_LE(deepest, 12);
    }
}

TEST(FlatBoxes, CoincidentItemsMakeNoDeepTree) {
    std::vector<FlatItem> items = random_items(20'000, 0);
    std::vector<glm::vec4> boxes;
    const std::uint32_t root = build_flat_boxes(items, boxes);
    std::map<std::uint32_t, int> met;
    int deepest = 0;
    walk(boxes, root, {Vec3(-1.0), Vec3(1.0)}, 1, met, deepest);
    EXPECT_EQ(met.size(), 20'000u);
    EXPECT_LE(deepest, 60);
}

TEST(FlatBoxes, NothingHasNoTree) {
    std::vector<FlatItem> items = {{{}, ENTRY_PART}};
    std::vector<glm::vec4> boxes;
    EXPECT_EQ(build_flat_boxes(items, boxes), NONE);
}

} // namespace
} // namespace graftal
