#include "runtime/render/samplings.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "compiler/detail/work.h"

namespace graftal {
namespace {

constexpr ImageSize size{100, 80};
constexpr double a_sample_seconds = size.width * size.height / WorkRates::samples;

TEST(Samplings, AllLooksTogether) {
    EXPECT_EQ(samples_a_pixel(samplings_of(2, false)), 4);
    EXPECT_EQ(samples_a_pixel(samplings_of({}, false)), 1);
    EXPECT_EQ(samples_a_pixel(samplings_of({}, true)), 1 + 1 / 4.0 + 1 / 16.0 + 1 / 64.0);
    EXPECT_EQ(samples_a_pixel(samplings_of(9, true)), 65536 + samples_a_pixel(samplings_of({}, true)));
}

TEST(Samplings, FewerUntilTheTimeSuffices) {
    for (const bool progressive : {false, true})
        for (int depth = 1; depth <= 9; ++depth) {
            const std::vector<Sampling> all = samplings_of(depth, progressive);
            EXPECT_EQ(samples_a_pixel(with_fewer_samples(all, size, least_seconds(all, size))),
                      samples_a_pixel(all));
            const std::vector<Sampling> few = with_fewer_samples(all, size, 100 * a_sample_seconds);
            EXPECT_LE(samples_a_pixel(few), 100);
            EXPECT_EQ(few.back().antialias.value_or(1), std::min(depth, 4)) << "4^3 samples";
            const std::vector<Sampling> least = with_fewer_samples(all, size, 0);
            EXPECT_EQ(least.back().samples_a_pixel(), 1) << "every pixel keeps one";
        }
}

TEST(Samplings, BlocksWhereSamplesTakeLong) {
    const std::vector<Sampling> all = samplings_of(3, false);
    EXPECT_EQ(within_seconds(all, 1, 16).back().samples_a_pixel(), 16);
    EXPECT_EQ(within_seconds(all, 1, 15).back().samples_a_pixel(), 4);
    EXPECT_EQ(within_seconds(all, 1, 3).back().samples_a_pixel(), 1);
    EXPECT_EQ(within_seconds(all, 1, 0.3).back().block, 2);
    EXPECT_EQ(within_seconds(all, 1, 0).back().block, 8);
    const std::vector<Sampling> looks = within_seconds(samplings_of(3, true), 1, 0.1);
    EXPECT_EQ(looks.size(), 2u);
    EXPECT_EQ(looks.back().block, 4);
}

TEST(Samplings, ADraftComesBeforeALongLook) {
    const Sampling fine{.antialias = 2};
    EXPECT_FALSE(draft_before(fine, 1, 4)) << "it takes no longer itself";
    EXPECT_EQ(draft_before(fine, 1, 3.9)->samples_a_pixel(), 1 / 4.0);
    EXPECT_EQ(draft_before(fine, 1, 0.1)->block, 4);
    EXPECT_EQ(draft_before(fine, 1e6, 0.1)->block, 16) << "the coarsest, however long it takes";
    EXPECT_FALSE(draft_before({.block = 8}, 1, 0.1));
    EXPECT_EQ(draft_before({.block = 8}, 1, 0.01)->block, 16);
    EXPECT_EQ(draft_before({.most_samples = 128}, 1, 0.3)->samples_a_pixel(), 1 / 4.0);
}

} // namespace
} // namespace graftal
