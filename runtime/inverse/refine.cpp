#include "runtime/inverse/refine.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <glm/geometric.hpp>

namespace graftal {

namespace {

template<typename Point> double squared_length(Point v) {
    return glm::dot(v, v);
}

/// Normal equations of maps: hessian * step = -gradient.
struct Normal {
    Eigen::MatrixXd hessian;
    Eigen::VectorXd gradient;

    explicit Normal(std::size_t numbers) { clear(numbers); }
    void clear(std::size_t numbers) {
        const auto size = static_cast<Eigen::Index>(numbers);
        hessian = Eigen::MatrixXd::Zero(size, size);
        gradient = Eigen::VectorXd::Zero(size);
    }
};

/// Whether this entry of a step is a coordinate of the image of the centre.
template<typename Map> bool is_place(std::size_t entry) {
    return entry % (Map::dimensions + 1) == Map::dimensions;
}

/// The directions in which each map stays a similarity: `similar_entries` of its `entries` dimensions.
template<typename Map> Eigen::MatrixXd similar_directions(const std::vector<Map>& maps) {
    constexpr auto all = static_cast<Eigen::Index>(Map::entries),
                   few = static_cast<Eigen::Index>(Map::similar_entries);
    const auto count = static_cast<Eigen::Index>(maps.size());
    Eigen::MatrixXd basis = Eigen::MatrixXd::Zero(all * count, few * count);
    for (Eigen::Index i = 0; i < count; ++i) {
        const auto steps = maps[static_cast<std::size_t>(i)].similar_steps();
        for (Eigen::Index k = 0; k < few; ++k)
            for (Eigen::Index j = 0; j < all; ++j)
                basis(all * i + j, few * i + k) =
                    steps[static_cast<std::size_t>(k)][static_cast<std::size_t>(j)];
    }
    return basis;
}

/// The slopes of a point's image along `direction`, by the entries of a step.
template<typename Map>
std::array<double, Map::entries> slopes_of(typename Map::Point direction, typename Map::Point arm) {
    std::array<double, Map::entries> slope;
    std::size_t entry = 0;
    for (int row = 0; row < direction.length(); ++row) {
        for (int column = 0; column < arm.length(); ++column)
            slope[entry++] = direction[row] * arm[column];
        slope[entry++] = direction[row];
    }
    return slope;
}

/// The maps after a damped step; false where there is none.
template<typename Map>
bool stepped(const Normal& normal, double damping, double floor, const TargetOf<Map>& target,
             const MapRules& rules, const std::vector<Map>& maps, std::vector<Map>& result) {
    Eigen::MatrixXd hessian = normal.hessian;
    const double linear = target.spread() * target.spread();
    for (Eigen::Index i = 0; i < hessian.rows(); ++i)
        hessian(i, i) +=
            damping * (hessian(i, i) + floor * (is_place<Map>(static_cast<std::size_t>(i)) ? 1 : linear)) +
            1e-12;
    Eigen::VectorXd step;
    if (rules.similar) {
        const Eigen::MatrixXd basis = similar_directions(maps);
        const Eigen::MatrixXd small = basis.transpose() * hessian * basis;
        step = -(basis * small.ldlt().solve(basis.transpose() * normal.gradient));
    } else {
        step = -hessian.ldlt().solve(normal.gradient);
    }
    if (!step.allFinite()) return false;
    result.resize(maps.size());
    for (std::size_t i = 0; i < maps.size(); ++i)
        result[i] = moved(maps[i], step.data() + Map::entries * i, target.centre(), rules.most_stretch);
    if (rules.similar && Map::dimensions == 3) // rotations of space are no linear space
        for (Map& map : result)
            map = nearest_similarity(map, target.centre());
    return true;
}

template<typename Map> class Refinement {
  public:
    using Point = typename Map::Point;
    using Maps = std::vector<Map>;

    Refinement(const TargetOf<Map>& target, const FitPoints<Point>& points, const LevelFit& fit,
               const MapRules& rules, std::size_t maps, Draws& draws)
        : target_(target), points_(points), fit_(fit), rules_(rules),
          levels_(static_cast<std::size_t>(fit.levels)), inner_(points.inner.size() * maps),
          outer_(points.outer.size()), normal_(entries * maps) {
        for (std::size_t i = 0; i < inner_.size(); ++i) {
            inner_[i].from = points.inner[i % points.inner.size()];
            inner_[i].letters[0] = static_cast<std::uint8_t>(i / points.inner.size());
            for (std::size_t level = 1; level < levels_; ++level)
                inner_[i].letters[level] = static_cast<std::uint8_t>(draws.below(maps));
        }
    }

    std::uint64_t run(Maps& maps) {
        const double reach = fit_.reach_px * fit_.reach_px;
        double error = assign(maps, outer_) + inner_error(maps);
        double damping = 1e-2;
        Maps trial;
        std::vector<Word> words(outer_.size());
        bool going_on = true;
        for (int i = 0; i < fit_.iterations && going_on; ++i) {
            gather(maps, reach);
            going_on = false;
            for (int attempt = 0; attempt < 5; ++attempt) {
                if (stepped(normal_, damping, 0.02 / static_cast<double>(maps.size()), target_, rules_, maps,
                            trial)) {
                    const double now = assign(trial, words) + inner_error(trial);
                    if (now < error) {
                        going_on = error - now > 1e-4 * error;
                        maps.swap(trial);
                        outer_.swap(words);
                        error = now;
                        damping = std::max(1e-6, 0.3 * damping);
                        break;
                    }
                }
                damping *= 6;
            }
        }
        return work_;
    }

  private:
    static constexpr std::size_t entries = Map::entries;
    /// The price of a block of the normal equations, over that in the plane.
    static constexpr std::size_t block_price = entries * entries / 36;

    struct Word {
        std::array<std::uint8_t, most_levels> letters{}; ///< the first is applied last
        Point from{0.0};                                 ///< a point of the target
    };

    double robust(double squared) const {
        const double reach = fit_.reach_px * fit_.reach_px;
        return squared * reach / (squared + reach);
    }

    Point image(const Maps& maps, const Word& word) const {
        Point p = word.from;
        for (std::size_t level = levels_; level-- > 0;)
            p = maps[word.letters[level]](p);
        return p;
    }

    double inner_error(const Maps& maps) {
        double sum = 0;
        for (const Word& word : inner_) {
            const Point p = image(maps, word);
            sum += robust(squared_length(p - target_.nearest(p)));
        }
        work_ += inner_.size() * levels_;
        return sum / static_cast<double>(inner_.size());
    }

    /// Finds the words of the outer points; returns their error.
    double assign(const Maps& maps, std::vector<Word>& words) {
        inverses_.clear();
        for (const Map& map : maps)
            inverses_.push_back(bounded_inverse(map, target_.centre(), 0.01));
        double sum = 0;
        for (std::size_t i = 0; i < words.size(); ++i) {
            Word& word = words[i];
            Point p = points_.outer[i];
            for (std::size_t level = 0; level < levels_; ++level) {
                double least = 1e300;
                Point before{0.0};
                for (std::size_t m = 0; m < maps.size(); ++m) {
                    const Point source = inverses_[m](p);
                    const Point known = target_.nearest(source);
                    const double squared = squared_length(maps[m](known) - p);
                    if (squared >= least) continue;
                    least = squared;
                    word.letters[level] = static_cast<std::uint8_t>(m);
                    before = source;
                }
                p = before;
            }
            word.from = target_.nearest(p);
            sum += robust(squared_length(image(maps, word) - points_.outer[i]));
        }
        work_ += words.size() * levels_ * maps.size();
        return sum / static_cast<double>(words.size());
    }

    /// Adds the word's residual: the distance of its image from `to`.
    void add(const Maps& maps, const Word& word, Point to, bool nearest, double weight, double reach) {
        std::array<Point, most_levels + 1> at;
        at[levels_] = word.from;
        for (std::size_t level = levels_; level-- > 0;)
            at[level] = maps[word.letters[level]](at[level + 1]);
        if (nearest) to = target_.nearest(at[0]);
        Point direction = at[0] - to;
        const double squared = squared_length(direction);
        if (squared < 1e-18) return;
        const double distance = std::sqrt(squared), kept = reach / (squared + reach);
        weight *= kept * kept;
        direction /= distance;
        std::array<std::array<double, entries>, most_levels> slope;
        for (std::size_t level = 0; level < levels_; ++level) {
            const Point arm = at[level + 1] - target_.centre();
            const Map& map = maps[word.letters[level]];
            slope[level] = slopes_of<Map>(direction, arm);
            direction = map.transposed(direction);
        }
        const Eigen::Index rows = normal_.hessian.rows();
        double* hessian = normal_.hessian.data();
        for (std::size_t l = 0; l < levels_; ++l) {
            const std::size_t row = entries * word.letters[l];
            for (std::size_t i = 0; i < entries; ++i)
                normal_.gradient[static_cast<Eigen::Index>(row + i)] += weight * distance * slope[l][i];
            for (std::size_t k = 0; k < levels_; ++k) {
                double* block = hessian + static_cast<std::size_t>(rows) * entries * word.letters[k] + row;
                for (std::size_t j = 0; j < entries; ++j, block += rows)
                    for (std::size_t i = 0; i < entries; ++i)
                        block[i] += weight * slope[l][i] * slope[k][j];
            }
        }
    }

    void gather(const Maps& maps, double reach) {
        normal_.clear(entries * maps.size());
        for (const Word& word : inner_)
            add(maps, word, {}, true, 1 / static_cast<double>(inner_.size()), reach);
        for (std::size_t i = 0; i < outer_.size(); ++i)
            add(maps, outer_[i], points_.outer[i], false, 1 / static_cast<double>(outer_.size()), reach);
        work_ += (inner_.size() + outer_.size()) * levels_ * levels_ * block_price;
    }

    const TargetOf<Map>& target_;
    const FitPoints<Point>& points_;
    const LevelFit& fit_;
    const MapRules& rules_;
    std::size_t levels_;
    std::vector<Word> inner_, outer_;
    Maps inverses_;
    Normal normal_;
    std::uint64_t work_ = 0;
};

/// The growth of one map, for one length tau.
template<typename Map> class MapGrowth {
  public:
    using Point = typename Map::Point;

    MapGrowth(const TargetOf<Map>& target, std::span<const Point> inner, double tau_px, const MapRules& rules)
        : target_(target), inner_(inner), rules_(rules),
          scale_(1 / (static_cast<double>(inner.size()) * tau_px * tau_px)) {}

    double value_of(const Map& map) {
        double sum = 0;
        for (const Point p : inner_) {
            const Point q = map(p);
            sum += squared_length(q - target_.nearest(q));
        }
        work_ += inner_.size();
        return sum * scale_ - growth * std::log(std::abs(map.determinant()) + least_size);
    }

    std::uint64_t run(int iterations, Map& map) {
        double damping = 1e-2, value = value_of(map);
        std::vector<Map> one(1, map), trial;
        Normal normal(entries);
        bool going_on = true;
        for (int i = 0; i < iterations && going_on; ++i) {
            gather(one.front(), normal);
            going_on = false;
            for (int attempt = 0; attempt < 4; ++attempt, damping *= 5) {
                const double floor = 0.1 * scale_ * static_cast<double>(inner_.size());
                if (!stepped(normal, damping, floor, target_, rules_, one, trial)) continue;
                const double now = value_of(trial.front());
                if (!(now < value)) continue;
                going_on = value - now > 1e-3;
                one.swap(trial);
                value = now;
                damping = std::max(1e-5, 0.3 * damping);
                break;
            }
        }
        map = one.front();
        return work_;
    }

  private:
    static constexpr std::size_t entries = Map::entries;
    static constexpr double growth = 0.05;                                    ///< mu
    static constexpr double least_size = Map::dimensions == 2 ? 1e-9 : 1e-12; ///< of a determinant

    void gather(const Map& map, Normal& normal) {
        std::array<double, entries * entries> hessian{};
        std::array<double, entries> gradient{};
        for (const Point p : inner_) {
            const Point q = map(p);
            Point direction = q - target_.nearest(q);
            const double squared = squared_length(direction);
            if (squared < 1e-18) continue;
            const double distance = std::sqrt(squared);
            direction /= distance;
            const Point arm = p - target_.centre();
            const std::array<double, entries> slope = slopes_of<Map>(direction, arm);
            for (std::size_t i = 0; i < entries; ++i) {
                gradient[i] += slope[i] * distance;
                for (std::size_t j = 0; j < entries; ++j)
                    hessian[i * entries + j] += slope[i] * slope[j];
            }
        }
        work_ += inner_.size();
        const std::array<double, entries> larger = map.log_slope();
        for (std::size_t i = 0; i < entries; ++i) {
            const auto row = static_cast<Eigen::Index>(i);
            normal.gradient[row] = 2 * scale_ * gradient[i] - growth * larger[i];
            for (std::size_t j = 0; j < entries; ++j)
                normal.hessian(row, static_cast<Eigen::Index>(j)) =
                    2 * scale_ * hessian[i * entries + j] + growth * larger[i] * larger[j];
        }
    }

    const TargetOf<Map>& target_;
    std::span<const Point> inner_;
    MapRules rules_;
    double scale_;
    std::uint64_t work_ = 0;
};

} // namespace

template<typename Map> Map ruled(const Map& map, const TargetOf<Map>& target, const MapRules& rules) {
    const std::array<double, Map::entries> still{};
    return moved(rules.similar ? nearest_similarity(map, target.centre()) : map, still.data(),
                 target.centre(), rules.most_stretch);
}

template<typename Map>
std::uint64_t grow(const TargetOf<Map>& target, std::span<const typename Map::Point> inner,
                   std::span<const double> tau_px, int iterations, const MapRules& rules, Map& map) {
    std::uint64_t work = 0;
    for (const double tau : tau_px)
        work += MapGrowth<Map>(target, inner, tau, rules).run(iterations, map);
    return work;
}

template<typename Map>
std::uint64_t refine(const TargetOf<Map>& target, const FitPoints<typename Map::Point>& points,
                     const LevelFit& fit, const MapRules& rules, Draws& draws, std::vector<Map>& maps) {
    return Refinement<Map>(target, points, fit, rules, maps.size(), draws).run(maps);
}

template<typename Map>
double growth_value(const TargetOf<Map>& target, std::span<const typename Map::Point> inner, double tau_px,
                    const Map& map) {
    return MapGrowth<Map>(target, inner, tau_px, MapRules()).value_of(map);
}

// NOLINTBEGIN(bugprone-macro-parentheses): a type in brackets is none
#define GRAFTAL_REFINE(Map)                                                                                  \
    template Map ruled(const Map&, const TargetOf<Map>&, const MapRules&);                                   \
    template std::uint64_t grow(const TargetOf<Map>&, std::span<const Map::Point>, std::span<const double>,  \
                                int, const MapRules&, Map&);                                                 \
    template double growth_value(const TargetOf<Map>&, std::span<const Map::Point>, double, const Map&);     \
    template std::uint64_t refine(const TargetOf<Map>&, const FitPoints<Map::Point>&, const LevelFit&,       \
                                  const MapRules&, Draws&, std::vector<Map>&);
GRAFTAL_REFINE(PlaneMap)
GRAFTAL_REFINE(SpaceMap)
#undef GRAFTAL_REFINE
// NOLINTEND(bugprone-macro-parentheses)

} // namespace graftal
