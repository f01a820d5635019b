#include "tests/image/absolute_specification.h"

#include <gtest/gtest.h>

namespace graftal {

namespace {

template<typename Compile> std::optional<TwoWays> two_ways(const Compile& compile) {
    std::optional<CompiledModel> cut = compile(CutOptions{});
    std::optional<CompiledModel> flat = compile(CutOptions{.flatten = true});
    if (!cut || !flat) return std::nullopt;
    EXPECT_GT(cut->cut.triangle_count, 0u) << "nothing is shared: the comparison would mean nothing";
    EXPECT_EQ(flat->cut.triangle_count, 0u);
    EXPECT_EQ(cut->cut.leaf_count, flat->cut.leaf_count);
    EXPECT_EQ(cut->cut.error_px, 0);
    if (testing::Test::HasFailure()) return std::nullopt;
    return TwoWays{std::move(*cut), std::move(*flat)};
}

} // namespace

std::optional<TwoWays> two_ways_of_file(const std::string& path, const StageOptions& options) {
    return two_ways([&](const CutOptions& cut) { return compile_file(path, options, cut); });
}

std::optional<TwoWays> two_ways_of_text(const std::string& name, const std::string& text,
                                        const StageOptions& options) {
    return two_ways([&](const CutOptions& cut) { return compile_text(name, text, options, cut); });
}

Agreement agreement_of(TwoWays ways) {
    Agreement result;
    result.lit = compare_images(draw(ways.cut, SampleFormat::srgb8), draw(ways.flat, SampleFormat::srgb8));
    result.pigment = pigment_agreement_of(std::move(ways), &result.covered);
    return result;
}

ImageDifference pigment_agreement_of(TwoWays ways, double* covered) {
    show_pigments(ways.cut);
    show_pigments(ways.flat);
    const Image cut = draw(ways.cut, SampleFormat::linear16), flat = draw(ways.flat, SampleFormat::linear16);
    if (covered) *covered = share_covered(flat);
    return compare_images(cut, flat, last_bit);
}

} // namespace graftal
