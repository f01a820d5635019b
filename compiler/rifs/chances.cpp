#include "compiler/rifs/chances.h"

#include <algorithm>
#include <cmath>

#include <glm/matrix.hpp>

#include "compiler/graph/markov.h"

namespace graftal {

namespace {

constexpr double restart = 0.05;             ///< of walks that would end, or stay in a part
constexpr double default_condensation = 0.1; ///< of points, where maps say theirs and add up to 1
constexpr double least_share = 0.01;

using Stated = std::vector<std::vector<std::optional<double>>>;

bool any_stated(const RifsSystem& system, const Stated& condensations) {
    for (const RifsNode& node : system.nodes) {
        if (node.probability) return true;
        for (const double weight : node.weights)
            if (weight != 1) return true;
    }
    for (const auto& block : condensations)
        for (const auto& part : block)
            if (part) return true;
    return false;
}

double size_of(const RifsNode& node) {
    return std::pow(std::abs(glm::determinant(node.map.linear)), 2.0 / 3.0);
}

class ChanceSolver {
  public:
    ChanceSolver(const RifsSystem& system, const Stated& condensations) : system_(system) {
        chances_.weight.assign(system.nodes.size(), 0.0);
        chances_.share.assign(system.nodes.size(), 0.0);
        chances_.row.assign(system.nodes.size(), 0.0);
        for (std::uint32_t b = 0; b < system.blocks.size(); ++b) {
            weigh_maps(system.blocks[b], condensations[b]);
            weigh_parts(b, condensations[b]);
        }
    }

    RifsChances solve() && {
        number_states();
        const bool whole = add_steps();
        const bool joined = whole && reaches_all(false) && reaches_all(true);
        if (!joined) restart_everywhere();
        const std::vector<double> shares = stationary_shares(states_, steps_);
        for (std::uint32_t i = 0; i < system_.nodes.size(); ++i)
            if (state_of_node_[i] != none) chances_.share[i] = shares[state_of_node_[i]];
        chances_.block_share.assign(system_.blocks.size(), 0.0);
        for (std::uint32_t b = 0; b < system_.blocks.size(); ++b)
            if (state_of_block_[b] != none) chances_.block_share[b] = shares[state_of_block_[b]];
        return std::move(chances_);
    }

  private:
    static constexpr std::uint32_t none = UINT32_MAX;

    void weigh_maps(const RifsSubsystem& block, const std::vector<std::optional<double>>& parts) {
        double stated = 0, sizes = 0;
        int silent = 0;
        for (const auto& part : parts)
            stated += part.value_or(0);
        for (std::uint32_t i = block.first; i < block.end; ++i) {
            const RifsNode& node = system_.nodes[i];
            stated += node.probability.value_or(0);
            if (node.probability) continue;
            sizes += size_of(node);
            ++silent;
        }
        const double rest = std::max(stated > 0 ? 1 - stated : 1, least_share * silent);
        for (std::uint32_t i = block.first; i < block.end; ++i) {
            const RifsNode& node = system_.nodes[i];
            const double by_size = sizes > 0 ? size_of(node) / sizes : 0;
            chances_.weight[i] = node.probability.value_or(std::max(rest * by_size, least_share * rest));
        }
    }

    void weigh_parts(std::uint32_t block, const std::vector<std::optional<double>>& stated) {
        double sum = 0, silent = 0;
        for (const auto& part : stated) {
            sum += part.value_or(0);
            silent += !part;
        }
        double maps = 0;
        for (std::uint32_t i = system_.blocks[block].first; i < system_.blocks[block].end; ++i)
            maps += chances_.weight[i];
        const double rest = std::max(1 - sum - maps, default_condensation);
        std::vector<double> parts;
        for (const auto& part : stated)
            parts.push_back(part.value_or(rest / silent));
        const double all = sum + (silent > 0 ? rest : 0);
        for (double& part : parts)
            part = all > 0 ? part / all : 0;
        chances_.parts.push_back(std::move(parts));
        chances_.block_anew.push_back(all > 0 ? all / (all + maps) : 0);
    }

    /// Nodes that the root reaches, and the condensation sets of the blocks on the way.
    void number_states() {
        state_of_node_.assign(system_.nodes.size(), none);
        state_of_block_.assign(system_.blocks.size(), none);
        std::vector<std::uint32_t> queue;
        const auto reach = [&](std::uint32_t node) {
            if (system_.nodes[node].empty || state_of_node_[node] != none) return;
            state_of_node_[node] = states_++;
            queue.push_back(node);
        };
        const auto reach_block = [&](std::uint32_t block) {
            if (chances_.block_anew[block] > 0 && state_of_block_[block] == none)
                state_of_block_[block] = states_++;
        };
        reach_block(system_.main);
        for (const std::uint32_t start : system_.blocks[system_.main].start)
            reach(start);
        while (!queue.empty()) {
            const RifsNode& node = system_.nodes[queue.back()];
            queue.pop_back();
            reach_block(node.block);
            reach_block(system_.block_under(node));
            for (const std::uint32_t master : node.masters)
                reach(master);
        }
    }

    static double weight_of_edge(const RifsNode& node, std::size_t i) {
        return node.weights.empty() ? 1 : node.weights[i];
    }

    /// False if a state has nothing that may follow.
    bool add_steps() {
        chances_.block_row.assign(system_.blocks.size(), 0.0);
        const auto each_edge = [&](const auto& visit) {
            for (std::uint32_t j = 0; j < system_.nodes.size(); ++j) {
                if (state_of_node_[j] == none) continue;
                const RifsNode& node = system_.nodes[j];
                for (std::size_t i = 0; i < node.masters.size(); ++i)
                    if (state_of_node_[node.masters[i]] != none)
                        visit(node.masters[i], j, chances_.weight[j] * weight_of_edge(node, i));
            }
        };
        each_edge([&](std::uint32_t i, std::uint32_t, double weight) { chances_.row[i] += weight; });
        for (std::uint32_t j = 0; j < system_.nodes.size(); ++j)
            if (state_of_node_[j] != none)
                chances_.block_row[system_.block_under(system_.nodes[j])] += chances_.weight[j];
        each_edge([&](std::uint32_t i, std::uint32_t j, double weight) {
            if (!(weight > 0)) return;
            const double goes_on = 1 - anew(system_.nodes[i].block);
            steps_.push_back({state_of_node_[i], state_of_node_[j], goes_on * weight / chances_.row[i]});
        });
        add_condensation_steps();
        return std::none_of(state_of_node_.begin(), state_of_node_.end(), [&](const std::uint32_t& state) {
            return state != none &&
                   !(chances_.row[static_cast<std::size_t>(&state - state_of_node_.data())] > 0);
        });
    }

    double anew(std::uint32_t block) const { return chances_.block_anew[block]; }

    void add_condensation_steps() {
        for (std::uint32_t i = 0; i < system_.nodes.size(); ++i)
            if (state_of_node_[i] != none && anew(system_.nodes[i].block) > 0)
                steps_.push_back({state_of_node_[i], state_of_block_[system_.nodes[i].block],
                                  anew(system_.nodes[i].block)});
        for (std::uint32_t b = 0; b < system_.blocks.size(); ++b)
            if (state_of_block_[b] != none)
                steps_.push_back({state_of_block_[b], state_of_block_[b], anew(b)});
        for (std::uint32_t j = 0; j < system_.nodes.size(); ++j) {
            const std::uint32_t under = system_.block_under(system_.nodes[j]);
            if (state_of_node_[j] == none || !(anew(under) > 0) || !(chances_.weight[j] > 0)) continue;
            steps_.push_back({state_of_block_[under], state_of_node_[j],
                              (1 - anew(under)) * chances_.weight[j] / chances_.block_row[under]});
        }
    }

    /// Whether one state leads to all (`back`: all lead to it).
    bool reaches_all(bool back) const {
        std::vector<std::vector<std::uint32_t>> next(states_);
        for (const WalkStep& step : steps_)
            back ? next[step.to].push_back(step.from) : next[step.from].push_back(step.to);
        std::vector<bool> reached(states_, false);
        std::vector<std::uint32_t> queue = {0};
        reached[0] = true;
        for (std::size_t i = 0; i < queue.size(); ++i)
            for (const std::uint32_t to : next[queue[i]])
                if (!reached[to]) {
                    reached[to] = true;
                    queue.push_back(to);
                }
        return queue.size() == states_;
    }

    /// Every state goes on to a further one, which leads to all, once in a while; or always, if it leads
    /// nowhere.
    void restart_everywhere() {
        std::vector<double> leaving(states_, 0.0);
        for (WalkStep& step : steps_) {
            step.chance *= 1 - restart;
            leaving[step.from] += step.chance;
        }
        const std::uint32_t hub = states_++;
        for (std::uint32_t state = 0; state < hub; ++state) {
            steps_.push_back({state, hub, 1 - leaving[state]});
            steps_.push_back({hub, state, 1.0 / hub});
        }
    }

    const RifsSystem& system_;
    RifsChances chances_;
    std::uint32_t states_ = 0;
    std::vector<std::uint32_t> state_of_node_, state_of_block_;
    std::vector<WalkStep> steps_;
};

} // namespace

RifsChances::OfNode RifsChances::of(const RifsSystem& system, const RifsNode& node) const {
    OfNode chances;
    const auto j = static_cast<std::size_t>(&node - system.nodes.data());
    for (std::size_t i = 0; i < node.masters.size(); ++i) {
        const std::uint32_t master = node.masters[i];
        const double edge = weight[j] * (node.weights.empty() ? 1 : node.weights[i]);
        const double goes_on = 1 - block_anew[system.nodes[master].block];
        chances.masters.push_back(row[master] > 0 ? share[master] * goes_on * edge / row[master] : 0);
    }
    const std::uint32_t under = system.block_under(node);
    for (const double part : parts[under])
        chances.condensations.push_back(block_row[under] > 0 ? block_share[under] * (1 - block_anew[under]) *
                                                                   part * weight[j] / block_row[under]
                                                             : 0);
    return chances;
}

std::optional<RifsChances> rifs_chances(const RifsSystem& system, const Stated& condensations) {
    if (!any_stated(system, condensations)) return std::nullopt;
    return ChanceSolver(system, condensations).solve();
}

} // namespace graftal
