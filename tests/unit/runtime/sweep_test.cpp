#include "runtime/render/sweep.h"

#include <map>

#include <gtest/gtest.h>

#include "runtime/render/frame_clock.h"

namespace graftal {
namespace {

TEST(Sweep, EndsAreExact) {
    EXPECT_EQ(swept(0.1, 0.7, 0), 0.1);
    EXPECT_EQ(swept(0.1, 0.7, 1), 0.7);
    EXPECT_EQ(swept_by_factor(0.3, 1e-20, 0), 0.3);
    EXPECT_EQ(swept_by_factor(0.3, 1e-20, 1), 1e-20);
    EXPECT_NEAR(swept_by_factor(1, 100, 0.5), 10, 1e-12);
    EXPECT_EQ(swept(Vec3(1, 2, 3), Vec3(3, 2, 1), 0.5), Vec3(2, 2, 2));
    EXPECT_EQ(swept(2.5, 2.5, 0.3), 2.5);
}

TEST(Sweep, WholeNumbersGetEqualShares) {
    for (const auto& [from, to] : {std::pair<std::uint64_t, std::uint64_t>{1, 12}, {12, 1}, {5, 5}, {0, 2}}) {
        std::map<std::uint64_t, int> frames;
        for (int frame = 0; frame < 60; ++frame)
            ++frames[swept_whole(from, to, frame / 59.0)];
        const std::uint64_t count = std::max(from, to) - std::min(from, to) + 1;
        EXPECT_EQ(frames.size(), count);
        for (const auto& [value, share] : frames)
            EXPECT_EQ(share, 60 / static_cast<int>(count)) << value;
        EXPECT_EQ(swept_whole(from, to, 0), from);
        EXPECT_EQ(swept_whole(from, to, 1), to);
    }
    EXPECT_LT(swept_whole(0, UINT64_MAX, 0.999999), UINT64_MAX);
    EXPECT_GT(swept_whole(0, UINT64_MAX, 0.999999), UINT64_MAX / 2);
    EXPECT_EQ(swept_whole(0, UINT64_MAX, 1), UINT64_MAX);
}

TEST(Sweep, StepsStartAtTheFirstValue) {
    EXPECT_EQ(swept_by_steps(1, 10, 1, 0), 1);
    EXPECT_EQ(swept_by_steps(1, 10, 1, 1), 10);
    EXPECT_EQ(swept_by_steps(1, 10, 4, 1), 9);
    EXPECT_EQ(swept_by_steps(10, 1, 3, 0.5), 4);
    EXPECT_EQ(swept_by_steps(0, 0.3, 0.1, 1), 3 * 0.1) << "0.3 / 0.1 is less than 3";
    EXPECT_EQ(swept_by_steps(2, 2, 1, 0.5), 2);
    EXPECT_EQ(swept_by_steps(0, 1e300, 1e-300, 1), 1e9 * 1e-300) << "no overflow";
}

TEST(Sweep, EaseIsSlowAtBothEnds) {
    EXPECT_EQ(eased(Ease::linear, 0.25), 0.25);
    EXPECT_EQ(eased(Ease::smooth, 0), 0);
    EXPECT_EQ(eased(Ease::smooth, 0.5), 0.5);
    EXPECT_EQ(eased(Ease::smooth, 1), 1);
    EXPECT_LT(eased(Ease::smooth, 0.1), 0.03);
}

TEST(FrameClock, GuessesFromTheLastFrames) {
    FrameClock clock;
    EXPECT_EQ(clock.seconds_left(5), std::nullopt);
    clock.add(100);
    EXPECT_EQ(clock.seconds_left(3), 300);
    for (int i = 0; i < 10; ++i)
        clock.add(2);
    EXPECT_EQ(clock.seconds_left(36), 72) << "the slow one is forgotten";
}

TEST(FrameClock, WordsOfDurations) {
    EXPECT_EQ(duration_text(0.4), "0 s");
    EXPECT_EQ(duration_text(59.4), "59 s");
    EXPECT_EQ(duration_text(72), "1 min 12 s");
    EXPECT_EQ(duration_text(3 * 3600 + 5 * 60 + 1), "3 h 5 min");
    EXPECT_EQ(duration_text(1e300), "277777 h 46 min");
}

} // namespace
} // namespace graftal
