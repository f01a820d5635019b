#include "compiler/graph/markov.h"

#include <cmath>

#include <gtest/gtest.h>

namespace graftal {
namespace {

TEST(Markov, StationarySharesOfTwoStates) {
    const std::vector<double> shares =
        stationary_shares(2, {{0, 0, 0.9}, {0, 1, 0.1}, {1, 0, 0.5}, {1, 1, 0.5}});
    EXPECT_NEAR(shares[0], 5 / 6., 1e-15);
    EXPECT_NEAR(shares[1], 1 / 6., 1e-15);
}

/// A walk over a ring that leaves some states less readily; it has a period.
std::vector<WalkStep> ring(std::uint32_t states) {
    std::vector<WalkStep> steps;
    for (std::uint32_t i = 0; i < states; ++i) {
        const double onwards = 0.5 + 0.4 * std::sin(i);
        steps.push_back({i, (i + 1) % states, onwards});
        steps.push_back({i, (i * 7 + 3) % states, 1 - onwards});
    }
    return steps;
}

TEST(Markov, StationarySharesAreStationary) {
    for (const std::uint32_t states : {1u, 3u, 100u, 1000u}) {
        const std::vector<WalkStep> steps = ring(states);
        const std::vector<double> shares = stationary_shares(states, steps);
        std::vector<double> next(states, 0.0);
        double sum = 0;
        for (const WalkStep& step : steps)
            next[step.to] += shares[step.from] * step.chance;
        for (std::uint32_t i = 0; i < states; ++i) {
            EXPECT_NEAR(next[i], shares[i], 1e-12);
            sum += shares[i];
        }
        EXPECT_NEAR(sum, 1, 1e-12);
    }
}

TEST(Markov, ExpectedVisits) {
    for (const std::uint32_t states : {1u, 3u, 100u, 1000u}) {
        std::vector<WalkStep> steps = ring(states);
        for (WalkStep& step : steps)
            step.chance *= 0.9; // a tenth leaves for good
        std::vector<double> begins(states, 0.0);
        begins[0] = 1;
        const std::vector<double> visits = expected_visits(begins, steps);
        std::vector<double> next = begins;
        double sum = 0;
        for (const WalkStep& step : steps)
            next[step.to] += visits[step.from] * step.chance;
        for (std::uint32_t i = 0; i < states; ++i) {
            EXPECT_NEAR(next[i], visits[i], 1e-11);
            sum += visits[i];
        }
        EXPECT_NEAR(sum, 10, 1e-9);
    }
}

} // namespace
} // namespace graftal
