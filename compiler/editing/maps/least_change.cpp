#include "compiler/editing/maps/least_change.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

namespace graftal {

namespace {

using Numbers = std::vector<double>;

double largest(const Numbers& numbers) {
    double most = 0;
    for (const double number : numbers)
        most = std::max(most, std::abs(number));
    return most;
}

double norm_of(const Numbers& numbers) {
    double sum = 0;
    for (const double number : numbers)
        sum += number * number;
    return sum;
}

/// The derivatives by central differences. Newton's method forgives their error.
std::optional<Eigen::MatrixXd> derivatives(const Numbers& at, const Numbers& units, const Residual& residual,
                                           std::size_t rows) {
    constexpr double step = 1e-6;
    Eigen::MatrixXd matrix(rows, at.size());
    for (std::size_t i = 0; i < at.size(); ++i) {
        Numbers moved = at;
        const double by = step * units[i];
        moved[i] = at[i] + by;
        const auto ahead = residual(moved);
        moved[i] = at[i] - by;
        const auto behind = residual(moved);
        if (!ahead || !behind) return std::nullopt;
        for (std::size_t row = 0; row < rows; ++row)
            matrix(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(i)) =
                ((*ahead)[row] - (*behind)[row]) / (2 * step);
    }
    return matrix;
}

} // namespace

std::optional<Numbers> solve_by_least_change(Numbers numbers, const Numbers& units, const Residual& residual,
                                             double tolerance) {
    constexpr int most_steps = 60, most_halvings = 12;
    auto error = residual(numbers);
    for (int step = 0; error && step < most_steps; ++step) {
        // Once more after the tolerance is reached costs little and takes the rest of the error away.
        const bool done = largest(*error) <= tolerance;
        const auto matrix = derivatives(numbers, units, residual, error->size());
        if (!matrix) return done ? std::optional(numbers) : std::nullopt;
        const Eigen::Map<const Eigen::VectorXd> wrong(error->data(),
                                                      static_cast<Eigen::Index>(error->size()));
        Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposed;
        decomposed.setThreshold(1e-10);
        decomposed.compute(*matrix);
        const Eigen::VectorXd change = decomposed.solve(-wrong);
        bool better = false;
        double share = 1;
        for (int halving = 0; halving < most_halvings && !better; ++halving, share /= 2) {
            Numbers next = numbers;
            for (std::size_t i = 0; i < next.size(); ++i)
                next[i] += share * change[static_cast<Eigen::Index>(i)] * units[i];
            const auto next_error = residual(next);
            if (!next_error || !(norm_of(*next_error) < norm_of(*error))) continue;
            numbers = std::move(next);
            error = next_error;
            better = true;
        }
        if (done) return numbers;
        if (!better) break;
    }
    return error && largest(*error) <= tolerance ? std::optional(numbers) : std::nullopt;
}

} // namespace graftal
