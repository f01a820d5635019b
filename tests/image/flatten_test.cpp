// The cut of two levels against the absolute specification, for Hart's models that are made of flat faces:
// both draw the same bodies, so the pictures must be the same.

#include <gtest/gtest.h>

#include "tests/image/absolute_specification.h"

namespace graftal {
namespace {

// A ray that runs along an edge, or cuts a corner by less than a ten-millionth of its length, hits either
// neighbour as POV-Ray's rounding has it. The sizes are chosen so that none does: framed by its height with a
// margin of a twentieth, a flat model on a dyadic grid has cells of 0.45 * height / 2^k pixels, so that of
// 180 rows many run along edges, and of 178 none.
constexpr ImageSize flat_size = {316, 178}, solid_size = {320, 180};

void expect_agreement(const Agreement& agreement, double least_covered) {
    testing::Test::RecordProperty("differing_pixels_lit", std::to_string(agreement.lit.differing));
    testing::Test::RecordProperty("differing_pixels_pigment_16_bit",
                                  std::to_string(agreement.pigment.differing));
    testing::Test::RecordProperty("largest_difference_in_65535ths",
                                  std::to_string(agreement.pigment.max * 65535));
    EXPECT_EQ(agreement.lit.differing, 0u);
    EXPECT_EQ(agreement.pigment.over_threshold, 0u) << agreement.pigment.max;
    EXPECT_GT(agreement.covered, least_covered) << "hardly anything was drawn";
}

void expect_both_ways_agree(const std::string& path, std::optional<unsigned> steps, double least_covered,
                            ImageSize size = flat_size) {
    std::optional<TwoWays> ways = two_ways_of_file(path, whole(size, steps));
    if (ways) expect_agreement(agreement_of(std::move(*ways)), least_covered);
}

TEST(Flatten, GasketByRecursion) {
    expect_both_ways_agree("scenes/hart/sierpinski.inst", 6, 0.03);
}

TEST(Flatten, GasketByLevels) {
    expect_both_ways_agree("scenes/hart/sierpinski_levels.inst", {}, 0.1);
}

TEST(Flatten, GasketAsATreeOfUnions) {
    expect_both_ways_agree("scenes/hart/sierpinski_tree.inst", {}, 0.1);
}

TEST(Flatten, PoundSign) {
    expect_both_ways_agree("scenes/hart/pound_sign.rifs", 4, 0.2, solid_size);
}

TEST(Flatten, PoundSignInThePlane) {
    expect_both_ways_agree("scenes/hart/pound_sign_2d.rifs", 5, 0.1);
}

// Figures 1, 2 and 3 of the paper are one picture by three models.
TEST(Flatten, ThreeWaysToTheGasketOfNineTriangles) {
    const auto picture = [](const std::string& path, std::optional<unsigned> steps) {
        const auto model = compile_file(path, whole(flat_size, steps));
        return model ? draw(*model, SampleFormat::linear16) : Image();
    };
    const Image recursion = picture("scenes/hart/sierpinski.inst", 2);
    const Image levels = picture("scenes/hart/sierpinski_levels.inst", {});
    const Image tree = picture("scenes/hart/sierpinski_tree.inst", {});
    ASSERT_EQ(tree.width, flat_size.width);
    EXPECT_EQ(compare_images(levels, tree).differing, 0u);
    EXPECT_EQ(compare_images(recursion, tree).differing, 0u);
}

} // namespace
} // namespace graftal
