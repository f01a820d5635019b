#include "runtime/fit/samplings.h"

#include <gtest/gtest.h>

#include "compiler/detail/work.h"

namespace graftal {
namespace {

const Sampling edges{.antialias = 3}; // 16 samples
const Sampling light{.most_samples = 64, .noise_255 = 3};
const Sampling denoised{.most_samples = 64, .noise_255 = 3, .denoise = true};
constexpr Sampling one_a_pixel{};

TEST(Samplings, AsManySamplesAsAreAffordable) {
    EXPECT_EQ(affordable_sampling(edges, 16), edges);
    EXPECT_EQ(affordable_sampling(edges, 1e9), edges);
    EXPECT_EQ(affordable_sampling(edges, 15.9), (Sampling{.most_samples = 15}));
    EXPECT_EQ(affordable_sampling(edges, 2), (Sampling{.most_samples = 2}));
    EXPECT_EQ(affordable_sampling(edges, 1.9), one_a_pixel) << "in the middle of each pixel";
    EXPECT_EQ(affordable_sampling(light, 7.5), (Sampling{.most_samples = 7, .noise_255 = 3}));
    EXPECT_EQ(affordable_sampling(light, 1), (Sampling{.most_samples = 1, .noise_255 = 3}));
}

TEST(Samplings, PixelsShareSamplesWhereEachTakesLong) {
    for (const Sampling& wanted : {edges, light, denoised, one_a_pixel}) {
        EXPECT_EQ(affordable_sampling(wanted, 0.99).block, 2);
        EXPECT_EQ(affordable_sampling(wanted, 0.25).block, 2);
        EXPECT_EQ(affordable_sampling(wanted, 0.2).block, 3);
        EXPECT_EQ(affordable_sampling(wanted, 0).block, coarsest_block);
    }
}

TEST(Samplings, NeverTakeMoreThanIsAffordable) {
    for (const Sampling& wanted : {edges, light, denoised, one_a_pixel})
        for (double samples = 1.0 / (coarsest_block * coarsest_block); samples < 100; samples *= 1.07)
            EXPECT_LE(affordable_sampling(wanted, samples).cost_in_samples(), samples * (1 + 1e-12));
}

/// Rays for features cost half a sample each, and are one for two samples up to four.
TEST(Samplings, FewSamplesAreDenoisedBeforeAllPixelsHaveThem) {
    const auto at = [](double samples) { return affordable_sampling(denoised, samples); };
    EXPECT_EQ(at(66), denoised);
    EXPECT_EQ(at(65).most_samples, 63);
    EXPECT_EQ(at(10).most_samples, 8);
    EXPECT_EQ(at(2.5).most_samples, 2);
    EXPECT_EQ(at(2.5).sparse, 1);
    EXPECT_EQ(at(2.4).most_samples, 2);
    EXPECT_EQ(at(2.4).sparse, 2);
    EXPECT_EQ(at(1.4).sparse, 4);
    EXPECT_EQ(at(1.4).samples_a_pixel(), 0.5);
    EXPECT_EQ(at(0.99).block, 2);
    for (const double samples : {1.0, 1.5, 2.0, 7.0, 64.0})
        EXPECT_TRUE(at(samples).denoise) << samples;
}

/// Fewer samples never look better, and no step is a cliff: one sample less costs less than parts twice as
/// large.
TEST(Samplings, LossGrowsEvenly) {
    for (const Sampling& wanted : {edges, light, denoised, one_a_pixel}) {
        EXPECT_EQ(loss_of_samples(wanted, wanted), 0);
        double last = 0;
        for (double samples = 70; samples > 0.02; samples *= 0.97) {
            const double loss = loss_of_samples(wanted, affordable_sampling(wanted, samples));
            EXPECT_GE(loss, last) << samples;
            EXPECT_LT(loss, last + 1.5) << samples;
            last = loss;
        }
        EXPECT_GT(last, 3) << "blocks are worse than parts eight times as large";
    }
}

TEST(Samplings, LooksComeBeforeALongOne) {
    EXPECT_TRUE(looks_before(light, 1e-3, 0.1).empty()) << "it is there as soon";
    const std::vector<Sampling> looks = looks_before(light, 1, 0.1);
    ASSERT_EQ(looks.size(), 2u);
    EXPECT_EQ(looks[0].block, 4) << "a sixteenth of a second";
    EXPECT_EQ(looks[1].block, 2);
    EXPECT_EQ(looks_before(light, 1e6, 0.1).front().block, 16) << "the coarsest, however long it takes";
    double taken = 0;
    for (const Sampling& look : looks_before(one_a_pixel, 1, 0.01))
        taken += look.samples_a_pixel();
    EXPECT_LT(taken, 0.1) << "a small share of the finest";
    EXPECT_TRUE(looks_before({.block = 16}, 1e6, 0.1).empty());
}

TEST(Samplings, SamplesThatMeetNothingTakeTime) {
    EXPECT_DOUBLE_EQ(least_seconds(light, {100, 80}), 64 * 100 * 80 / WorkRates::samples);
}

} // namespace
} // namespace graftal
