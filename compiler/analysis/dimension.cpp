#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Dense>

#include "compiler/analysis/counts.h"
#include "compiler/analysis/cycle_graph.h"
#include "compiler/analysis/partition.h"

namespace graftal {

namespace {

struct Ratio {
    std::uint32_t from = 0;
    std::uint32_t to = 0;
    double log_ratio = 0;
};

/// One component with objects of equal growth taken together, which keeps the spectral radius.
struct RatioGraph {
    std::uint32_t size = 0;
    std::vector<Ratio> edges;
};

/// Nothing if an instance within the component is no similarity.
std::optional<RatioGraph> ratio_graph(const CycleGraph& cycle) {
    LabelledGraph labelled;
    labelled.label.assign(cycle.size(), 0.0);
    labelled.edges.resize(cycle.size());
    for (const CycleEdge& edge : cycle.edges) {
        const double ratio = similarity_ratio(cycle.transform(edge).linear);
        if (!(ratio > 0)) return std::nullopt;
        // Rounded, so that rotations of one ratio are alike.
        constexpr double grain = 0x1p-43;
        labelled.edges[edge.from].push_back({edge.to, std::round(std::log(ratio) / grain) * grain});
    }
    const Partition partition = group_equal_nodes(labelled);
    RatioGraph result;
    result.size = partition.size();
    for (std::uint32_t c = 0; c < partition.size(); ++c)
        for (const LabelledGraph::Edge& edge : labelled.edges[partition.representative[c]])
            result.edges.push_back({c, partition.class_of[edge.to], edge.label});
    return result;
}

/// Whether the radius of a non-negative matrix is below 1: then, and only then, all pivots of I - M are
/// positive, without any exchange of rows (I - M is an M-matrix).
bool radius_below_one(const RatioGraph& graph, double s) {
    Eigen::MatrixXd m = Eigen::MatrixXd::Identity(graph.size, graph.size);
    for (const Ratio& edge : graph.edges)
        m(edge.from, edge.to) -= std::exp(s * edge.log_ratio);
    for (Eigen::Index k = 0; k < m.rows(); ++k) {
        if (!(m(k, k) > 0)) return false;
        const Eigen::Index rest = m.rows() - k - 1;
        const Eigen::VectorXd column = m.col(k).tail(rest) / m(k, k);
        m.bottomRightCorner(rest, rest).noalias() -= column * m.row(k).tail(rest);
    }
    return true;
}

/// radius_below_one() for large sparse matrices, by iteration: nothing if Collatz's bounds stay apart.
std::optional<bool> radius_below_one_sparse(const RatioGraph& graph, double s) {
    std::vector<double> factor;
    for (const Ratio& edge : graph.edges)
        factor.push_back(std::exp(s * edge.log_ratio));
    std::vector<double> x(graph.size, 1.0);
    std::vector<double> next(graph.size);
    for (std::uint64_t visits = 0; visits < 4'000'000; visits += graph.edges.size()) {
        next = x; // of I + M, which is aperiodic
        for (std::size_t e = 0; e < graph.edges.size(); ++e)
            next[graph.edges[e].from] += factor[e] * x[graph.edges[e].to];
        double least = INFINITY, most = 0, largest = 0;
        for (std::uint32_t v = 0; v < graph.size; ++v) {
            least = std::min(least, next[v] / x[v]);
            most = std::max(most, next[v] / x[v]);
            largest = std::max(largest, next[v]);
        }
        if (most < 2) return true;
        if (least > 2) return false;
        if (most - least < 1e-12) return true; // the radius is 1 to rounding
        for (std::uint32_t v = 0; v < graph.size; ++v)
            x[v] = std::max(next[v] / largest, 1e-300);
    }
    return std::nullopt;
}

/// The s at which the radius is 1; it falls with s if every cycle contracts, else there is none.
std::optional<double> dimension_of(const RatioGraph& graph) {
    constexpr std::uint32_t largest_dense = 160;
    const auto below = [&graph](double s) -> std::optional<bool> {
        if (graph.size <= largest_dense) return radius_below_one(graph, s);
        return radius_below_one_sparse(graph, s);
    };
    if (graph.edges.size() == graph.size) { // one cycle: a single point
        double log_sum = 0;
        for (const Ratio& edge : graph.edges)
            log_sum += edge.log_ratio;
        return log_sum < 0 ? std::optional<double>(0) : std::nullopt;
    }
    double low = 0;
    double high = 1;
    for (;; low = high, high *= 2) {
        const std::optional<bool> found = below(high);
        if (!found || high > 1e6) return std::nullopt;
        if (*found) break;
    }
    for (int halving = 0; halving < 60 && high - low > 1e-13 * high; ++halving) {
        const double s = 0.5 * (low + high);
        const std::optional<bool> found = below(s);
        if (!found) return std::nullopt;
        (*found ? high : low) = s;
    }
    return 0.5 * (low + high);
}

std::vector<bool> reachable_components(const Graph& graph, const Components& components) {
    std::vector<bool> reached(components.members.size(), false);
    reached[components.component_of[graph.root]] = true;
    for (std::size_t c = components.members.size(); c-- > 0;) { // users before their masters
        if (!reached[c]) continue;
        for (const ObjectId id : components.members[c])
            for (const Instance& instance : graph.objects[id].instances)
                reached[components.component_of[instance.master]] = true;
    }
    return reached;
}

} // namespace

std::optional<double> similarity_dimension(const Graph& graph, const Components& components) {
    const std::vector<bool> reached = reachable_components(graph, components);
    const std::vector<std::uint32_t> places = places_in_components(components);
    std::optional<double> largest;
    for (std::uint32_t c = 0; c < components.members.size(); ++c) {
        if (!components.cyclic[c] || !reached[c]) continue;
        const std::optional<RatioGraph> ratios = ratio_graph(cycle_graph(graph, components, places, c));
        const std::optional<double> dimension = ratios ? dimension_of(*ratios) : std::nullopt;
        if (!dimension) return std::nullopt;
        largest = std::max(largest.value_or(0), *dimension);
    }
    return largest;
}

} // namespace graftal
