#include "compiler/primitives/triangle_tree.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace graftal {
namespace {

/// Large triangles that lie across each other: a ray comes to the boxes of a large share of them.
std::vector<Triangle> spikes(std::size_t count) {
    std::mt19937 generator(5);
    const auto point = [&] {
        const auto number = [&] { return static_cast<double>(generator()) / 2147483648.0 - 1; };
        const double x = number(), y = number();
        return Vec3(x, y, number());
    };
    std::vector<Triangle> triangles(count);
    for (Triangle& triangle : triangles)
        for (Vec3& corner : triangle)
            corner = point();
    return triangles;
}

/// From above, down through the middle or near it.
Ray ray(int number) {
    return {{0.03 * (number % 10) - 0.15, 0.03 * (number / 10) - 0.15, 3}, {0.01, -0.02, -1}};
}

TEST(TriangleTree, CountsTheTrianglesThatARayIsHeldAgainst) {
    const TriangleTree tree(spikes(3)); // one leaf
    TriangleHit hit;
    std::uint32_t number = 0;
    std::uint64_t steps = 0;
    tree.meet(ray(0), {}, hit, number, steps);
    EXPECT_EQ(steps, 4u);
}

TEST(TriangleTree, MeetsTheFirstOfAll) {
    const TriangleTree tree(spikes(2000));
    const TriangleRay near(ray(7), 1);
    double first = INFINITY;
    for (const Triangle& triangle : tree.triangles())
        if (TriangleHit at; near.meet(triangle, {}, at)) first = std::min(first, at.t);
    TriangleHit hit;
    std::uint32_t number = 0;
    std::uint64_t steps = 0;
    ASSERT_TRUE(tree.meet(ray(7), {}, hit, number, steps));
    EXPECT_NEAR(hit.t, first, 1e-9);
}

// Rays through 200,000 such triangles took milliseconds each, however little work was allowed.
TEST(TriangleTree, EndsAfterTheMostStepsAndMeetsWhatIsInFront) {
    const TriangleTree tree(spikes(20'000));
    constexpr std::uint64_t most_steps = 100, a_leaf = 8;
    std::uint64_t whole_steps = 0;
    for (int i = 0; i < 100; ++i) {
        TriangleHit exact, hit;
        std::uint32_t number = 0;
        ASSERT_TRUE(tree.meet(ray(i), {}, exact, number, whole_steps));
        std::uint64_t steps = 0;
        ASSERT_TRUE(tree.meet(ray(i), {}, hit, number, steps, most_steps)) << i;
        EXPECT_LE(steps, most_steps + a_leaf);
        EXPECT_LT(number, 20'000u);
        EXPECT_GE(hit.t, 1.9); // the box of all begins at 2 and ends at 4
        EXPECT_LE(hit.t, 4.1);
    }
    EXPECT_GT(whole_steps / 100, 20 * most_steps);
}

// A box that a ray does not come to is not met, however few steps are left.
TEST(TriangleTree, PassesByWithoutSteps) {
    const TriangleTree tree(spikes(1000));
    TriangleHit hit;
    std::uint32_t number = 0;
    std::uint64_t steps = 0;
    EXPECT_FALSE(tree.meet({{5, 5, 5}, {0, 0, -1}}, {}, hit, number, steps, 1));
}

} // namespace
} // namespace graftal
