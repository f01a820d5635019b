#include "compiler/analysis/metric.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/matrix.hpp>

#include "compiler/analysis/cycle_mean.h"

namespace graftal {

namespace {

constexpr std::array<double, 9> factors = {2, 1.5, 1.25, 1.12, 1.06, 1.03, 1.015, 1.007, 1.003};
constexpr double worst_condition = 1e6;
constexpr double log_of_nothing = -1e3;

using Metrics = std::vector<Mat3>; // symmetric, by local object

double trace(const Metrics& metrics) {
    double sum = 0;
    for (const Mat3& p : metrics)
        sum += p[0][0] + p[1][1] + p[2][2];
    return sum;
}

/// L(P), times `scale`.
Metrics pulled_back(const CycleGraph& cycle, const std::vector<Mat3>& linear, const Metrics& p,
                    double scale) {
    Metrics result(p.size(), Mat3(0.0));
    for (std::size_t e = 0; e < linear.size(); ++e)
        result[cycle.edges[e].to] += scale * (glm::transpose(linear[e]) * p[cycle.edges[e].from] * linear[e]);
    return result;
}

/// The growth of |L^k(I)| per application, over the second half of `rounds`, which averages out periods.
double growth(const CycleGraph& cycle, const std::vector<Mat3>& linear, int rounds) {
    Metrics p(cycle.size(), Mat3(1.0));
    double log_size = 0, log_size_half_way = 0;
    for (int round = 0; round < rounds; ++round) {
        if (round == rounds / 2) log_size_half_way = log_size;
        const double size = trace(p);
        if (!(size > 1e-280)) return 0;
        log_size += std::log(size);
        p = pulled_back(cycle, linear, p, 1 / size);
    }
    return std::exp((log_size - log_size_half_way) / (rounds - rounds / 2));
}

/// P = L^T L with L upper triangular. Requires P >= I.
Mat3 upper_factor(const Mat3& p) {
    Mat3 l(0.0); // l[column][row], row <= column
    for (int row = 0; row < 3; ++row) {
        for (int column = row; column < 3; ++column) {
            double sum = p[column][row];
            for (int k = 0; k < row; ++k)
                sum -= l[row][k] * l[column][k];
            l[column][row] = column == row ? std::sqrt(std::max(sum, 0.0)) : sum / l[row][row];
        }
    }
    return l;
}

/// Adds the weights that go best with the metrics; false if these are of no use.
bool complete(const CycleGraph& cycle, MetricChoice& choice) {
    for (const Mat3& l : choice.metric) {
        const Vec3 sigma = singular_values(l);
        if (!(sigma.z > 0) || !std::isfinite(sigma.x)) return false;
        choice.condition = std::max(choice.condition, sigma.x / sigma.z);
    }
    if (choice.condition > worst_condition) return false;
    std::vector<double> weight;
    for (const Mat3& linear : seen_by(cycle, choice)) {
        weight.push_back(log_norm(linear));
        if (!std::isfinite(weight.back())) return false;
    }
    CycleMean found = max_cycle_mean(cycle, weight);
    for (std::size_t v = 0; v < choice.log_weight.size(); ++v)
        choice.log_weight[v] += found.potential[v];
    choice.log_rate = found.bound;
    return true;
}

} // namespace

double log_norm(const Mat3& linear) {
    const double size = largest_entry(linear);
    return size > 0 ? std::log(size) + std::log(norm(linear * (1 / size))) : log_of_nothing;
}

std::vector<Mat3> seen_by(const CycleGraph& cycle, const MetricChoice& choice) {
    std::vector<Mat3> inverse;
    for (const Mat3& l : choice.metric)
        inverse.push_back(glm::inverse(l));
    std::vector<Mat3> result;
    for (const CycleEdge& edge : cycle.edges) {
        const double unit = std::exp(choice.log_weight[edge.to] - choice.log_weight[edge.from]);
        result.push_back(unit * (choice.metric[edge.from] * cycle.transform(edge).linear * inverse[edge.to]));
    }
    return result;
}

std::vector<MetricChoice> search_metrics(const CycleGraph& cycle, const MetricChoice& plain,
                                         std::uint64_t& most_visits) {
    const std::uint64_t edges = cycle.edges.size();
    const int affordable = static_cast<int>(std::min<std::uint64_t>(most_visits / edges, 2000));
    if (affordable < 40) return {};
    const int rounds_of_growth = std::min(affordable / 4, 120);
    const int rounds = std::min(affordable / 2, 1200);
    most_visits -= edges * static_cast<std::uint64_t>(rounds_of_growth + rounds);

    const std::vector<Mat3> linear = seen_by(cycle, plain);
    const double rho = growth(cycle, linear, rounds_of_growth);
    if (!(rho > 0)) return {};
    std::array<Metrics, factors.size()> sums;
    sums.fill(Metrics(cycle.size(), Mat3(0.0)));
    Metrics term(cycle.size(), Mat3(1.0));
    std::array<double, factors.size()> share;
    share.fill(1);
    for (int k = 0; k < rounds; ++k) {
        for (std::size_t i = 0; i < factors.size(); ++i) {
            if (share[i] < 1e-12) continue;
            for (std::uint32_t v = 0; v < cycle.size(); ++v)
                sums[i][v] += share[i] * term[v];
            share[i] /= factors[i] * factors[i];
        }
        term = pulled_back(cycle, linear, term, 1 / rho);
    }
    std::vector<MetricChoice> choices;
    for (const Metrics& sum : sums) {
        MetricChoice choice;
        choice.log_weight = plain.log_weight;
        for (const Mat3& p : sum)
            choice.metric.push_back(upper_factor(p));
        if (complete(cycle, choice)) choices.push_back(std::move(choice));
    }
    return choices;
}

} // namespace graftal
