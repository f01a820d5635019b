#include "compiler/lsys/derive/competition.h"

#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

namespace graftal {
namespace {

std::vector<Competitor> competition(const std::vector<double>& probabilities) {
    std::vector<Competitor> competitors;
    double sum = 0;
    for (const double probability : probabilities) {
        competitors.push_back({nullptr, probability});
        sum += probability;
    }
    share_draws(competitors, sum);
    return competitors;
}

constexpr std::uint64_t half = std::uint64_t{1} << 63;

TEST(LsysCompetition, drawsLieEndToEnd) {
    const std::vector<Competitor> competitors = competition({0.5, 0.25, 0.25});
    EXPECT_EQ(choose(competitors.data(), 0).entrant, &competitors[0]);
    EXPECT_EQ(choose(competitors.data(), half).entrant, &competitors[0]);
    EXPECT_EQ(choose(competitors.data(), half + 1).entrant, &competitors[1]);
    EXPECT_EQ(choose(competitors.data(), UINT64_MAX).entrant, &competitors[2]);
}

TEST(LsysCompetition, probabilitiesOfBooksShareAllDraws) {
    const std::vector<Competitor> competitors = competition({0.33, 0.33, 0.33});
    EXPECT_EQ(choose(competitors.data(), half).entrant, &competitors[1]);
    EXPECT_EQ(choose(competitors.data(), UINT64_MAX).entrant, &competitors[2]);
}

TEST(LsysCompetition, noDrawChoosesOneOfNoProbability) {
    const std::vector<Competitor> competitors = competition({0, 0.5, 0, 0.5, 0});
    ASSERT_EQ(competitors.size(), 2u);
    EXPECT_EQ(choose(competitors.data(), 0).entrant, &competitors[0]);
    EXPECT_EQ(choose(competitors.data(), UINT64_MAX).entrant, &competitors[1]);
}

TEST(LsysCompetition, evenDrawsGiveEvenSets) {
    const std::vector<Competitor> competitors = competition({0.5, 0.5});
    std::vector<int> seen(draw_sets);
    for (std::uint32_t i = 0; i < draw_sets; ++i)
        ++seen[choose(competitors.data(), draw_at((i + 0.5) / (2.0 * draw_sets))).even().set];
    EXPECT_EQ(seen, std::vector<int>(draw_sets, 1));
    EXPECT_EQ(choose(competitors.data(), half).even().set, draw_sets - 1);
}

} // namespace
} // namespace graftal
