#pragma once

#include <cstdint>
#include <vector>

namespace graftal {

/// A step of a random walk over states 0, 1, 2, ...
struct WalkStep {
    std::uint32_t from = 0;
    std::uint32_t to = 0;
    double chance = 0;
};

/// The share of time that a walk spends in each state. Requires that the chances of the steps from each state
/// add up to 1, and that every state is reached from every other. Exact to rounding for up to a few hundred
/// states (Grassmann, Taksar and Heyman 1985: elimination without subtraction), by iteration for more.
std::vector<double> stationary_shares(std::uint32_t states, const std::vector<WalkStep>& steps);

/// The mean numbers of visits to each state of walks that start in state s `begins[s]` times, starts
/// included, and leave the states for good: x = begins + x P. Requires that no state's chances add up to
/// more than 1, and that every state leads to one whose chances add up to less.
std::vector<double> expected_visits(const std::vector<double>& begins, const std::vector<WalkStep>& steps);

} // namespace graftal
