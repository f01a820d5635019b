#include "compiler/graph/walk.h"

#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "compiler/graph/path.h"

namespace graftal {
namespace {

/// A number leads to its two halves, the larger first.
template<typename Order> void push_halves(Walk<int, Order>& walk, int number) {
    if (number < 2) return;
    walk.push(number - number / 2);
    walk.push(number / 2);
}

TEST(Walk, DepthFirstTakesChildrenInTheirOrder) {
    Walk<int> walk;
    walk.push(5);
    std::string met;
    for (int number = 0; walk.next(number);) {
        met += std::to_string(number);
        push_halves(walk, number);
    }
    EXPECT_EQ(met, "532111211");
    EXPECT_EQ(walk.visits(), 9u);
    EXPECT_FALSE(walk.stopped());
}

TEST(Walk, LargestFirst) {
    Walk<int, std::less<>> walk;
    walk.push(6);
    std::string met;
    for (int number = 0; walk.next(number);) {
        met += std::to_string(number);
        push_halves(walk, number);
    }
    EXPECT_EQ(met, "63322111111");
}

TEST(Walk, ChildrenCanBeTakenBack) {
    Walk<int> walk;
    walk.push(1);
    walk.push(9);
    int number = 0;
    ASSERT_TRUE(walk.next(number));
    EXPECT_EQ(number, 1);
    for (const int child : {2, 3, 4, 5})
        walk.push(child);
    EXPECT_EQ(walk.children(), 4u);
    walk.drop_children_if([](int child) { return child % 2 == 0; });
    std::string met;
    while (walk.next(number))
        met += std::to_string(number);
    EXPECT_EQ(met, "359");
    walk.push(7);
    walk.drop_children();
    EXPECT_FALSE(walk.next(number));
}

TEST(Walk, EndsAtItsLimits) {
    Walk<int> few({.most_visits = 3});
    few.push(5);
    for (int number = 0; few.next(number);)
        push_halves(few, number);
    EXPECT_TRUE(few.stopped());
    EXPECT_EQ(few.visits(), 3u);
}

TEST(Walk, IsCancelledByItsMeter) {
    bool cancelled = false;
    const Control control{CancelFlag([&] { return cancelled; }), {}};
    WorkMeter meter(control, "walk", 10);
    Walk<int> endless({.meter = &meter});
    endless.push(1);
    const auto walk = [&] {
        for (int number = 0; endless.next(number);) {
            endless.push(number);
            cancelled = endless.visits() == 1000;
        }
    };
    EXPECT_THROW(walk(), Cancelled);
    EXPECT_EQ(endless.visits(), 1001u);
}

TEST(Path, AnInstanceAddsToWhatHolds) {
    Graph graph;
    const ObjectId sphere = graph.primitive(PrimitiveKind::sphere);
    const ObjectId self = graph.add({"self", {}, {}, {}, {}});
    Instance again;
    again.master = self;
    again.parent_from_child = Affine::scale(Vec3(0.5));
    again.tint = {Rgb(1, 0, 0), 0.5};
    Instance ball;
    ball.master = sphere;
    ball.material = 3;
    graph.objects[self].instances = {again, ball};
    graph.root = self;
    const Components components = strong_components(graph);
    const PathState start{self, Affine::translate({1, 0, 0}), {}, 2, 4};
    const PathState deeper = descend(start, again, components);
    EXPECT_EQ(deeper.object, self);
    EXPECT_EQ(deeper.world_from_object, start.world_from_object * again.parent_from_child);
    EXPECT_EQ(deeper.material, 2u) << "the parent's";
    EXPECT_EQ(deeper.levels, 5u);
    EXPECT_EQ(deeper.tint.alpha, 0.5);
    const PathState leaf = descend(deeper, ball, components);
    EXPECT_EQ(leaf.material, 3u);
    EXPECT_EQ(leaf.levels, 5u) << "what ends takes no level";
    again.levels = 7;
    EXPECT_EQ(descend(start, again, components).levels, 11u);
    EXPECT_FALSE(is_part(again, components));
    again.levels = 0;
    EXPECT_TRUE(is_part(again, components));
}

} // namespace
} // namespace graftal
