#include "compiler/analysis/gripenberg.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace graftal {

namespace {

constexpr int deepest = 1000;
constexpr std::uint32_t no_parent = UINT32_MAX;

/// Least gain of a walk over the best one to count as better and not as rounding.
constexpr double better = 1e-10;

struct Path {
    std::uint32_t start = 0; // local objects
    std::uint32_t end = 0;
    std::uint32_t node = 0; // in the tree of paths
    double log_scale = 0;   // the product is exp(log_scale) * product
    double log_best = 0;    // the least rate of its prefixes
    Mat3 product{1.0};
};

double frobenius(const Mat3& m) {
    double sum = 0;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            sum += m[column][row] * m[column][row];
    return std::sqrt(sum);
}

class Search {
  public:
    Search(const CycleGraph& cycle, const MetricChoice& choice, const PathSearchLimits& limits)
        : cycle_(cycle), limits_(limits), seen_(seen_by(cycle, choice)) {
        found_.log_lower = limits.log_lower;
        found_.log_rate = rate_sought(limits.log_lower);
        drop_repeated_edges();
        choice_rate_ = choice.log_rate;
    }

    PathSearch run() {
        std::vector<Path> paths;
        for (std::uint32_t v = 0; v < cycle_.size(); ++v) {
            Path empty;
            empty.start = empty.end = v;
            empty.node = no_parent;
            empty.log_best = choice_rate_;
            paths.push_back(empty);
        }
        while (!paths.empty() && found_.depth < deepest) {
            ++found_.depth;
            std::vector<Path> longer;
            for (std::size_t i = 0; i < paths.size(); ++i) {
                if (found_.products > limits_.products || found_.log_lower >= 0) {
                    take_in(paths.begin() + static_cast<std::ptrdiff_t>(i), paths.end());
                    take_in(longer.begin(), longer.end());
                    return found_;
                }
                extend(paths[i], longer);
            }
            std::swap(paths, longer);
        }
        take_in(paths.begin(), paths.end());
        return found_;
    }

  private:
    double rate_sought(double log_lower) const { return limits_.prove ? 0.5 * log_lower : log_lower + 0.01; }

    /// Instances of one master by one linear part make the same products: keeps the first of each.
    void drop_repeated_edges() {
        for (std::uint32_t v = 0; v < cycle_.size(); ++v) {
            first_.push_back(static_cast<std::uint32_t>(edges_.size()));
            std::vector<std::uint32_t> order(cycle_.first[v + 1] - cycle_.first[v]);
            std::iota(order.begin(), order.end(), cycle_.first[v]);
            const auto key = [this](std::uint32_t e) {
                const Mat3& m = cycle_.transform(cycle_.edges[e]).linear;
                return std::tuple(cycle_.edges[e].to, m[0][0], m[0][1], m[0][2], m[1][0], m[1][1], m[1][2],
                                  m[2][0], m[2][1], m[2][2]);
            };
            std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return key(a) < key(b); });
            order.erase(
                std::unique(order.begin(), order.end(), [&](auto a, auto b) { return key(a) == key(b); }),
                order.end());
            std::sort(order.begin(), order.end());
            edges_.insert(edges_.end(), order.begin(), order.end());
        }
        first_.push_back(static_cast<std::uint32_t>(edges_.size()));
    }

    void extend(const Path& path, std::vector<Path>& longer) {
        const double length = found_.depth;
        for (std::uint32_t i = first_[path.end]; i < first_[path.end + 1]; ++i) {
            const std::uint32_t e = edges_[i];
            ++found_.products;
            Path next = path;
            next.end = cycle_.edges[e].to;
            next.product = path.product * seen_[e];
            const double rough_size = frobenius(next.product);
            if (!(rough_size > 1e-300)) continue;
            if (path.log_scale + std::log(rough_size) <= length * found_.log_rate) continue;
            const double log_size = path.log_scale + std::log(norm(next.product));
            if (log_size <= length * found_.log_rate) continue;
            next.log_best = std::min(path.log_best, log_size / length);
            next.product *= 1 / rough_size;
            next.log_scale += std::log(rough_size);
            next.node = static_cast<std::uint32_t>(tree_.size());
            tree_.push_back({path.node, e});
            if (next.end == next.start && may_grow_faster(next, length)) consider(next.node, length);
            longer.push_back(next);
        }
    }

    /// Tests the product at hand; quickly false by |M^4|^(1/4), which is at least the spectral radius.
    bool may_grow_faster(const Path& path, double length) const {
        const double least = length * (found_.log_lower + better) - path.log_scale;
        const Mat3 square = path.product * path.product;
        if (0.25 * std::log(frobenius(square * square)) <= least) return false;
        return std::log(spectral_radius(path.product)) > least;
    }

    void consider(std::uint32_t node, double length) {
        std::vector<std::uint32_t> walk;
        for (; node != no_parent; node = tree_[node].parent)
            walk.push_back(tree_[node].edge);
        std::reverse(walk.begin(), walk.end());
        const double log_rate = log_spectral_radius(cycle_, walk) / length;
        if (!(log_rate > found_.log_lower + better)) return;
        found_.log_lower = log_rate;
        found_.log_rate = std::max(found_.log_rate, rate_sought(log_rate));
        found_.walk = std::move(walk);
    }

    /// Paths that have not shrunk at the rate sought raise it to what they reached.
    void take_in(std::vector<Path>::const_iterator first, std::vector<Path>::const_iterator last) {
        for (; first != last; ++first)
            found_.log_rate = std::max(found_.log_rate, first->log_best);
    }

    const CycleGraph& cycle_;
    const PathSearchLimits& limits_;
    std::vector<Mat3> seen_;           // by edge
    std::vector<std::uint32_t> edges_; // followed ones, by object
    std::vector<std::uint32_t> first_; // edges of v: edges_[first_[v]] .. edges_[first_[v + 1] - 1]
    struct Node {
        std::uint32_t parent;
        std::uint32_t edge;
    };
    std::vector<Node> tree_;
    double choice_rate_ = 0; // no single instance shrinks less
    PathSearch found_;
};

} // namespace

PathSearch search_paths(const CycleGraph& cycle, const MetricChoice& choice, const PathSearchLimits& limits) {
    return Search(cycle, choice, limits).run();
}

} // namespace graftal
