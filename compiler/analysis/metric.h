#pragma once

#include <cstdint>
#include <vector>

#include "compiler/analysis/cycle_graph.h"

namespace graftal {

/// Weights and metrics for the objects of a component, and how much its linear parts shrink by them.
struct MetricChoice {
    std::vector<Mat3> metric;       ///< L by local object, upper triangular
    std::vector<double> log_weight; ///< by local object
    double log_rate = 0;            ///< max over edges v <- u of log |L_v A L_u^-1| + log p_u - log p_v
    double condition = 1;           ///< the worst condition number of the metrics
};

/// The log of a norm, where a vanishing one gives a very small number in place of -infinity.
double log_norm(const Mat3& linear);

/// Linear parts as the metrics and weights of a choice see them: edge by edge L_v A L_u^-1 p_u / p_v.
std::vector<Mat3> seen_by(const CycleGraph& cycle, const MetricChoice& choice);

/// Choices with other metrics than `plain` (whose metrics are identities, with the best weights for these):
/// P = sum over k of L^k(I) / (f^2 rho)^k for several f, where L(P)_u = sum over edges v <- u of A^T P_v A
/// has spectral radius rho; the weights are the best for each. Bounds with f near 1 are tight, but their
/// metrics are ill-conditioned. Uses up to `most_visits` visits of edges, and takes them off it.
std::vector<MetricChoice> search_metrics(const CycleGraph& cycle, const MetricChoice& plain,
                                         std::uint64_t& most_visits);

} // namespace graftal
