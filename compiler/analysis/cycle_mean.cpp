#include "compiler/analysis/cycle_mean.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace graftal {

namespace {

constexpr std::uint64_t max_edge_visits = 30'000'000;

class PolicyIteration {
  public:
    PolicyIteration(const CycleGraph& cycle, const std::vector<double>& weight)
        : cycle_(cycle), weight_(weight), policy_(cycle.size()), potential_(cycle.size(), 0.0) {
        for (std::uint32_t v = 0; v < cycle.size(); ++v) {
            policy_[v] = cycle.first[v];
            for (std::uint32_t e = cycle.first[v]; e < cycle.first[v + 1]; ++e)
                if (weight[e] > weight[policy_[v]]) policy_[v] = e;
        }
        index_by_master();
    }

    CycleMean run() {
        CycleMean best;
        best.mean = -std::numeric_limits<double>::infinity();
        std::uint64_t visits = 0;
        do {
            find_best_cycle();
            if (mean_ > best.mean) {
                best.mean = mean_;
                best.cycle = best_cycle_;
            }
            evaluate();
            visits += 2 * cycle_.edges.size();
        } while (improve() && visits < max_edge_visits);
        best.potential = potential_;
        best.bound = -std::numeric_limits<double>::infinity();
        for (std::size_t e = 0; e < cycle_.edges.size(); ++e) {
            const CycleEdge& edge = cycle_.edges[e];
            best.bound = std::max(best.bound, weight_[e] + potential_[edge.to] - potential_[edge.from]);
        }
        best.bound = std::max(best.bound, best.mean);
        return best;
    }

  private:
    void index_by_master() {
        const std::uint32_t n = cycle_.size();
        into_first_.assign(n + 1, 0);
        for (const CycleEdge& edge : cycle_.edges)
            ++into_first_[edge.to + 1];
        for (std::uint32_t v = 0; v < n; ++v)
            into_first_[v + 1] += into_first_[v];
        into_.resize(cycle_.edges.size());
        std::vector<std::uint32_t> next(into_first_.begin(), into_first_.end() - 1);
        for (std::uint32_t e = 0; e < cycle_.edges.size(); ++e)
            into_[next[cycle_.edges[e].to]++] = e;
    }

    /// Each object follows one edge, so the walk from any object ends in a cycle.
    void find_best_cycle() {
        const std::uint32_t n = cycle_.size();
        std::vector<std::uint32_t> seen_from(n, UINT32_MAX);
        mean_ = -std::numeric_limits<double>::infinity();
        for (std::uint32_t start = 0; start < n; ++start) {
            std::uint32_t v = start;
            while (seen_from[v] == UINT32_MAX) {
                seen_from[v] = start;
                v = cycle_.edges[policy_[v]].to;
            }
            if (seen_from[v] == start) consider_cycle(v);
        }
    }

    void consider_cycle(std::uint32_t start) {
        std::vector<std::uint32_t> walk;
        double sum = 0;
        std::uint32_t v = start;
        do {
            walk.push_back(policy_[v]);
            sum += weight_[policy_[v]];
            v = cycle_.edges[policy_[v]].to;
        } while (v != start);
        const double mean = sum / static_cast<double>(walk.size());
        if (mean > mean_) {
            mean_ = mean;
            best_cycle_ = std::move(walk);
        }
    }

    /// Values of the policy relative to the best cycle: first backwards along policy edges, then along any
    /// edge for objects whose policy ends in another cycle (they change over to the best one).
    void evaluate() {
        std::vector<bool> known(cycle_.size(), false);
        std::vector<std::uint32_t> order;
        const std::uint32_t start = cycle_.edges[best_cycle_.front()].from;
        known[start] = true;
        potential_[start] = 0;
        order.push_back(start);
        spread(order, known, true);
        spread(order, known, false);
    }

    void spread(std::vector<std::uint32_t>& order, std::vector<bool>& known, bool policy_only) {
        for (std::size_t i = 0; i < order.size(); ++i) {
            const std::uint32_t to = order[i];
            for (std::uint32_t k = into_first_[to]; k < into_first_[to + 1]; ++k) {
                const std::uint32_t e = into_[k];
                const std::uint32_t from = cycle_.edges[e].from;
                if (known[from] || (policy_only && policy_[from] != e)) continue;
                known[from] = true;
                policy_[from] = e;
                potential_[from] = weight_[e] - mean_ + potential_[to];
                order.push_back(from);
            }
        }
    }

    bool improve() {
        bool improved = false;
        for (std::uint32_t e = 0; e < cycle_.edges.size(); ++e) {
            const CycleEdge& edge = cycle_.edges[e];
            const double value = weight_[e] - mean_ + potential_[edge.to];
            const double old =
                weight_[policy_[edge.from]] - mean_ + potential_[cycle_.edges[policy_[edge.from]].to];
            if (value <= old + 1e-13 * (1 + std::abs(old))) continue;
            policy_[edge.from] = e;
            improved = true;
        }
        return improved;
    }

    const CycleGraph& cycle_;
    const std::vector<double>& weight_;
    std::vector<std::uint32_t> policy_; // by object: the edge it follows
    std::vector<double> potential_;
    std::vector<std::uint32_t> into_; // edge numbers by master
    std::vector<std::uint32_t> into_first_;
    double mean_ = 0;
    std::vector<std::uint32_t> best_cycle_;
};

} // namespace

CycleMean max_cycle_mean(const CycleGraph& cycle, const std::vector<double>& weight) {
    return PolicyIteration(cycle, weight).run();
}

} // namespace graftal
