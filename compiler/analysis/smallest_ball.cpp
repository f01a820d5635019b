#include "compiler/analysis/smallest_ball.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <Eigen/Dense>
#include <glm/geometric.hpp>

namespace graftal {

namespace {

constexpr double slack = 1e-10;
constexpr std::size_t most_in_basis = 4;

double reach(Vec3 centre, const Ball& ball) {
    return glm::length(ball.centre - centre) + ball.radius;
}

/// The ball with its centre in the affine hull of theirs that all of `balls` touch from inside. From
/// |x| = rho and |x - q_j| = rho - d_j, relative to the first: q_j . x = (|q_j|^2 - d_j^2) / 2 + rho d_j.
std::optional<Ball> touching_ball(std::span<const Ball> balls) {
    const Ball& first = balls.front();
    if (balls.size() == 1) return first;
    const auto n = static_cast<Eigen::Index>(balls.size() - 1);
    Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3> q(3, n);
    Eigen::Matrix<double, Eigen::Dynamic, 2, 0, 3, 2> right(n, 2);
    for (Eigen::Index j = 0; j < n; ++j) {
        const Ball& ball = balls[static_cast<std::size_t>(j) + 1];
        const Vec3 offset = ball.centre - first.centre;
        const double d = ball.radius - first.radius;
        for (int i = 0; i < 3; ++i)
            q(i, j) = offset[i];
        right(j, 0) = 0.5 * (glm::dot(offset, offset) - d * d);
        right(j, 1) = d;
    }
    const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3> gram = q.transpose() * q;
    const auto solver = gram.fullPivLu();
    if (!solver.isInvertible()) return std::nullopt;
    // x = u + rho w.
    const Eigen::Matrix<double, 3, 2> solution = q * solver.solve(right);
    const Eigen::Vector3d u = solution.col(0), w = solution.col(1);
    const double a = w.squaredNorm() - 1, half_b = u.dot(w), c = u.squaredNorm();
    const double discriminant = half_b * half_b - a * c;
    if (!(discriminant >= 0)) return std::nullopt;
    const double root = std::sqrt(discriminant);
    double least = 0;
    for (const Ball& ball : balls)
        least = std::max(least, ball.radius - first.radius);
    std::optional<double> rho;
    for (const double candidate : {(-half_b - root) / a, (-half_b + root) / a})
        if (candidate >= least * (1 - slack) && (!rho || candidate < *rho)) rho = candidate;
    if (!rho || !std::isfinite(*rho)) return std::nullopt;
    const Eigen::Vector3d x = u + *rho * w;
    return Ball{first.centre + Vec3(x(0), x(1), x(2)), first.radius + *rho};
}

struct Basis {
    std::vector<Ball> balls;
    Ball about;
};

/// The smallest ball about at most five balls, the last of which is known to touch it; by all subsets.
std::optional<Basis> basis_of(const std::vector<Ball>& balls) {
    std::optional<Basis> best;
    const std::size_t others = balls.size() - 1;
    for (unsigned subset = 0; subset < 1u << others; ++subset) {
        std::vector<Ball> chosen{balls.back()};
        for (std::size_t i = 0; i < others; ++i)
            if ((subset >> i & 1u) != 0) chosen.push_back(balls[i]);
        if (chosen.size() > most_in_basis) continue;
        const std::optional<Ball> about = touching_ball(chosen);
        if (!about || (best && about->radius >= best->about.radius)) continue;
        const bool holds_all = std::all_of(balls.begin(), balls.end(), [&](const Ball& ball) {
            return reach(about->centre, ball) <= about->radius * (1 + slack);
        });
        if (holds_all) best = Basis{std::move(chosen), *about};
    }
    return best;
}

} // namespace

Ball smallest_ball(std::span<const Ball> balls) {
    if (balls.empty()) return {};
    Basis basis{{balls.front()}, balls.front()};
    for (int exchange = 0; exchange < 100; ++exchange) {
        const auto farthest = std::max_element(balls.begin(), balls.end(), [&](const Ball& a, const Ball& b) {
            return reach(basis.about.centre, a) < reach(basis.about.centre, b);
        });
        if (reach(basis.about.centre, *farthest) <= basis.about.radius * (1 + slack)) break;
        std::vector<Ball> candidates = basis.balls;
        candidates.push_back(*farthest);
        std::optional<Basis> next = basis_of(candidates);
        // The radius grows with each exchange; where rounding prevents it, this is as near as it gets.
        if (!next || next->about.radius <= basis.about.radius) break;
        basis = std::move(*next);
    }
    Ball result{basis.about.centre, 0};
    for (const Ball& ball : balls)
        result.radius = std::max(result.radius, reach(result.centre, ball));
    return result;
}

} // namespace graftal
