#include "runtime/farm/sweep_axes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "runtime/farm/job.h"

namespace graftal {
namespace {

using testing::ElementsAre;

std::vector<std::string> values(const std::string& text) {
    const auto axis = parse_sweep_axis(text);
    EXPECT_TRUE(axis) << text;
    return axis ? axis->values : std::vector<std::string>();
}

TEST(SweepAxes, RangesAndListsAreReadAsPeopleWriteThem) {
    EXPECT_THAT(values("seed=1..4"), ElementsAre("1", "2", "3", "4"));
    EXPECT_THAT(values("k=0..1 by 0.25"), ElementsAre("0", "0.25", "0.5", "0.75", "1"));
    EXPECT_THAT(values("k=0..1 by 0.3"), ElementsAre("0", "0.3", "0.6", "0.9"));
    EXPECT_THAT(values("k=0.3..0 by 0.1"), ElementsAre("0.3", "0.2", "0.1", "0"));
    EXPECT_THAT(values("k=-1..1"), ElementsAre("-1", "0", "1"));
    EXPECT_THAT(values("k=5"), ElementsAre("5"));
    EXPECT_THAT(values("a_1=0.10,2e3,-7"), ElementsAre("0.10", "2e3", "-7"));
    EXPECT_THAT(values("k=1e-13..3e-13 by 1e-13"), ElementsAre("1e-13", "2e-13", "3e-13"));
    EXPECT_THAT(values("k=-0.1..0.1 by 0.1"), ElementsAre("-0.1", "0", "0.1"));
    EXPECT_THAT(values("seed=1000000000000..1000000000002"),
                ElementsAre("1000000000000", "1000000000001", "1000000000002"));
    EXPECT_EQ(values("k=0..1 by 0.1").size(), 11u); // 0.1 ten times is not quite 1
    EXPECT_EQ(values("seed=1..100000").size(), most_tasks);
}

TEST(SweepAxes, MalformedOnesAndTooManyAreRefused) {
    for (const char* text : {"",
                             "k",
                             "k=",
                             "=1",
                             "1k=1",
                             "k=a",
                             "k=1..",
                             "k=..2",
                             "k=1..2 by 0",
                             "k=1..2 by -1",
                             "k=1..2 by",
                             "k=1,",
                             "k=1,,2",
                             "k=nan",
                             "k=0..inf",
                             "k k=1",
                             "k=1..2..3",
                             "seed=0..100000",
                             "k=0..1e30",
                             "k=0..1 by 1e-300"})
        EXPECT_FALSE(parse_sweep_axis(text)) << text;
}

TEST(SweepAxes, SeedAndStepsHaveOptionsOfTheirOwn) {
    EXPECT_THAT(parse_sweep_axis("seed=3")->words("3"), ElementsAre("--seed", "3"));
    EXPECT_THAT(parse_sweep_axis("steps=3")->words("3"), ElementsAre("--steps", "3"));
    EXPECT_THAT(parse_sweep_axis("k=3")->words("0.5"), ElementsAre("--set", "k=0.5"));
}

TEST(SweepAxes, AGridHasEveryCombinationOnceTheLastAxisFastest) {
    const std::vector<SweepAxis> axes = {*parse_sweep_axis("a=1,2"), *parse_sweep_axis("b=3..5")};
    ASSERT_EQ(point_count(axes), 6u);
    EXPECT_EQ(column_count(axes), 3u);
    EXPECT_THAT(values_at(axes, 0), ElementsAre("1", "3"));
    EXPECT_THAT(values_at(axes, 1), ElementsAre("1", "4"));
    EXPECT_THAT(values_at(axes, 3), ElementsAre("2", "3"));
    EXPECT_THAT(values_at(axes, 5), ElementsAre("2", "5"));
    EXPECT_EQ(column_count({*parse_sweep_axis("a=1..10")}), 4u);
    const SweepAxis many = *parse_sweep_axis("a=1..100000");
    EXPECT_GT(point_count({many, many, many, many, many}), most_tasks);
}

} // namespace
} // namespace graftal
