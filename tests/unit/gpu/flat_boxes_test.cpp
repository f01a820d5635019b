#include "runtime/gpu/flat_boxes.h"

#include <bit>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "runtime/gpu/flat_model.h"

namespace graftal {
namespace {

struct Walk {
    std::map<std::uint32_t, int> met; ///< by entry: how often
    int deepest = 0;
};

/// Meets the entries below a node, whose boxes must lie in `outer`, or a single one.
void walk(const std::vector<glm::vec4>& boxes, std::uint32_t node, const Box& outer, int depth, Walk& seen) {
    seen.deepest = std::max(seen.deepest, depth);
    if ((node & ~ENTRY_NUMBER) != 0) {
        ++seen.met[node];
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
        walk(boxes, entry, box, depth + ((entry & ~ENTRY_NUMBER) == 0 ? 1 : 0), seen);
    }
}

Walk walked(std::vector<FlatItem> items) {
    std::vector<glm::vec4> boxes;
    const std::uint32_t root = build_flat_boxes(items, boxes);
    Walk seen;
    walk(boxes, root, {Vec3(-2.0), Vec3(2.0)}, 1, seen);
    return seen;
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
        const Walk seen = walked(random_items(count, 1));
        EXPECT_EQ(seen.met.size(), count);
        for (const auto& [entry, times] : seen.met)
            EXPECT_EQ(times, 1) << entry;
        EXPECT_LE(seen.deepest, 12);
    }
}

TEST(FlatBoxes, CoincidentItemsMakeNoDeepTree) {
    const Walk seen = walked(random_items(20'000, 0));
    EXPECT_EQ(seen.met.size(), 20'000u);
    EXPECT_LE(seen.deepest, 60);
}

TEST(FlatBoxes, NothingHasNoTree) {
    std::vector<FlatItem> items = {{{}, ENTRY_PART}};
    std::vector<glm::vec4> boxes;
    EXPECT_EQ(build_flat_boxes(items, boxes), NONE);
}

} // namespace
} // namespace graftal
