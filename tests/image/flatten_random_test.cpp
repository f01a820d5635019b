// The cut of two levels against the absolute specification, for models at random.

#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

#include "tests/image/absolute_specification.h"
#include "tests/image/parted_cut.h"
#include "tests/image/random_model.h"

namespace graftal {
namespace {

constexpr std::uint64_t models = 12;
constexpr ImageSize size = {128, 96};

/// By seed, so that all levels get their turn.
constexpr double thresholds[] = {40, 200, 1000, std::numeric_limits<double>::infinity()};

void expect_the_flattened_to_agree(const std::string& name, std::string (*text_of)(std::uint64_t),
                                   unsigned steps) {
    double widest = 0, largest = 0;
    for (std::uint64_t seed = 1; seed <= models; ++seed) {
        const std::string text = text_of(seed);
        SCOPED_TRACE(text);
        StageOptions options = whole(size, steps);
        const std::optional<CompiledModel> flat = compile_text(name, text, options, {.flatten = true});
        if (!flat) return;
        CompiledModel cut = parted_at(*flat, thresholds[seed % std::size(thresholds)]);
        EXPECT_GT(cut.cut.triangle_count, 0u) << "nothing is shared: the comparison would mean nothing";
        double covered = 0;
        const ImageDifference difference = pigment_agreement_of({std::move(cut), *flat}, &covered);
        EXPECT_EQ(difference.over_threshold, 0u) << "seed " << seed << ", " << difference.max;
        EXPECT_GT(covered, 0.01);
        widest = std::max(widest, covered);
        largest = std::max(largest, difference.max);
    }
    EXPECT_GT(widest, 0.1) << "all models are specks";
    testing::Test::RecordProperty("largest_difference_in_65535ths", std::to_string(largest * 65535));
}

TEST(FlattenRandom, Rifs) {
    expect_the_flattened_to_agree("random.rifs", random_rifs, 4);
}

TEST(FlattenRandom, Inst) {
    expect_the_flattened_to_agree("random.inst", random_inst, 5);
}

} // namespace
} // namespace graftal
