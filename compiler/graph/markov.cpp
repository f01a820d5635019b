#include "compiler/graph/markov.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace graftal {

namespace {

/// Elimination takes states^3 products, iteration steps * rounds.
constexpr std::uint32_t most_eliminated = 320;
constexpr std::uint64_t most_products = 2'000'000'000;
constexpr double settled = 1e-14;

/// A dense square matrix of chances, row by row.
class Chances {
  public:
    Chances(std::uint32_t size, const std::vector<WalkStep>& steps)
        : size_(size), values_(static_cast<std::size_t>(size) * size, 0.0) {
        for (const WalkStep& step : steps)
            at(step.from, step.to) += step.chance;
    }
    double& at(std::uint32_t from, std::uint32_t to) {
        return values_[static_cast<std::size_t>(from) * size_ + to];
    }

    /// Takes out the last state of `size`: walks through it become steps between the others. `leaving` is the
    /// chance to leave it, by a step to another or for good.
    void take_out(std::uint32_t last, double leaving) {
        for (std::uint32_t from = 0; from < last; ++from) {
            const double there = at(from, last) / leaving;
            if (there == 0) continue;
            at(from, last) = there;
            for (std::uint32_t to = 0; to < last; ++to)
                at(from, to) += there * at(last, to);
        }
    }

  private:
    std::uint32_t size_;
    std::vector<double> values_;
};

void normalise(std::vector<double>& shares) {
    double sum = 0;
    for (const double share : shares)
        sum += share;
    for (double& share : shares)
        share /= sum;
}

std::vector<double> eliminated_shares(std::uint32_t states, const std::vector<WalkStep>& steps) {
    Chances chances(states, steps);
    for (std::uint32_t last = states - 1; last > 0; --last) {
        double leaving = 0;
        for (std::uint32_t to = 0; to < last; ++to)
            leaving += chances.at(last, to);
        chances.take_out(last, leaving);
    }
    std::vector<double> shares(states, 1.0);
    for (std::uint32_t state = 1; state < states; ++state) {
        double share = 0;
        for (std::uint32_t from = 0; from < state; ++from)
            share += shares[from] * chances.at(from, state);
        shares[state] = share;
    }
    normalise(shares);
    return shares;
}

/// The sum of |a - b| over that of a.
double change(const std::vector<double>& a, const std::vector<double>& b) {
    double difference = 0, sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        difference += std::abs(a[i] - b[i]);
        sum += std::abs(a[i]);
    }
    return sum > 0 ? difference / sum : 0;
}

std::uint64_t most_rounds(std::size_t states, std::size_t steps) {
    return std::max<std::uint64_t>(64, most_products / (states + steps + 1));
}

std::vector<double> iterated_shares(std::uint32_t states, const std::vector<WalkStep>& steps) {
    std::vector<double> shares(states, 1.0 / states), next;
    for (std::uint64_t rounds = most_rounds(states, steps.size()); rounds > 0; --rounds) {
        next = shares; // of a walk that rests every other time, which cannot swing for ever
        for (const WalkStep& step : steps)
            next[step.to] += step.chance * shares[step.from];
        normalise(next);
        shares.swap(next);
        if (change(shares, next) < settled) break;
    }
    return shares;
}

std::vector<double> eliminated_visits(std::vector<double> visits, const std::vector<WalkStep>& steps) {
    const auto states = static_cast<std::uint32_t>(visits.size());
    Chances chances(states, steps);
    for (std::uint32_t last = states; last-- > 0;) {
        const double leaving = 1 - chances.at(last, last);
        const double passing = visits[last] / leaving;
        visits[last] = passing;
        for (std::uint32_t to = 0; to < last; ++to)
            visits[to] += passing * chances.at(last, to);
        chances.take_out(last, leaving);
    }
    for (std::uint32_t state = 1; state < states; ++state)
        for (std::uint32_t from = 0; from < state; ++from)
            visits[state] += visits[from] * chances.at(from, state);
    return visits;
}

std::vector<double> iterated_visits(const std::vector<double>& begins, const std::vector<WalkStep>& steps) {
    std::vector<double> visits = begins, next;
    for (std::uint64_t rounds = most_rounds(begins.size(), steps.size()); rounds > 0; --rounds) {
        next = begins;
        for (const WalkStep& step : steps)
            next[step.to] += step.chance * visits[step.from];
        visits.swap(next);
        if (change(visits, next) < settled) break;
    }
    return visits;
}

} // namespace

std::vector<double> stationary_shares(std::uint32_t states, const std::vector<WalkStep>& steps) {
    return states <= most_eliminated ? eliminated_shares(states, steps) : iterated_shares(states, steps);
}

std::vector<double> expected_visits(const std::vector<double>& begins, const std::vector<WalkStep>& steps) {
    return begins.size() <= most_eliminated ? eliminated_visits(begins, steps)
                                            : iterated_visits(begins, steps);
}

} // namespace graftal
