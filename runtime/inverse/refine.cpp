#include "runtime/inverse/refine.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace graftal {

namespace {

constexpr std::size_t entries = 6; ///< of a map: a, b, x, c, d, y; x and y are the image of the centre

double squared_length(Vec2 v) {
    return v.x * v.x + v.y * v.y;
}

/// Normal equations of maps: hessian * step = -gradient.
struct Normal {
    Eigen::MatrixXd hessian;
    Eigen::VectorXd gradient;

    explicit Normal(std::size_t maps) { clear(maps); }
    void clear(std::size_t maps) {
        const auto size = static_cast<Eigen::Index>(entries * maps);
        hessian = Eigen::MatrixXd::Zero(size, size);
        gradient = Eigen::VectorXd::Zero(size);
    }
};

/// The directions in which each map stays a similarity: four of its six entries' space.
Eigen::MatrixXd similar_directions(const PlaneMaps& maps) {
    const auto count = static_cast<Eigen::Index>(maps.size());
    Eigen::MatrixXd basis = Eigen::MatrixXd::Zero(6 * count, 4 * count);
    for (Eigen::Index i = 0; i < count; ++i) {
        const double mirror = maps[static_cast<std::size_t>(i)].determinant() < 0 ? -1 : 1;
        basis(6 * i + 0, 4 * i + 0) = 1; // a
        basis(6 * i + 4, 4 * i + 0) = mirror;
        basis(6 * i + 3, 4 * i + 1) = 1; // c
        basis(6 * i + 1, 4 * i + 1) = -mirror;
        basis(6 * i + 2, 4 * i + 2) = basis(6 * i + 5, 4 * i + 3) = 1;
    }
    return basis;
}

/// The maps after a damped step; false where there is none.
bool stepped(const Normal& normal, double damping, double floor, const Target& target, const MapRules& rules,
             const PlaneMaps& maps, PlaneMaps& result) {
    Eigen::MatrixXd hessian = normal.hessian;
    const double linear = target.spread() * target.spread();
    for (Eigen::Index i = 0; i < hessian.rows(); ++i)
        hessian(i, i) += damping * (hessian(i, i) + floor * (i % 3 == 2 ? 1 : linear)) + 1e-12;
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
        result[i] = moved(maps[i], step.data() + entries * i, target.centre(), rules.most_stretch);
    return true;
}

class Refinement {
  public:
    Refinement(const Target& target, const FitPoints& points, const LevelFit& fit, const MapRules& rules,
               std::size_t maps, Draws& draws)
        : target_(target), points_(points), fit_(fit), rules_(rules),
          levels_(static_cast<std::size_t>(fit.levels)), inner_(points.inner.size() * maps),
          outer_(points.outer.size()), normal_(maps) {
        for (std::size_t i = 0; i < inner_.size(); ++i) {
            inner_[i].from = points.inner[i % points.inner.size()];
            inner_[i].letters[0] = static_cast<std::uint8_t>(i / points.inner.size());
            for (std::size_t level = 1; level < levels_; ++level)
                inner_[i].letters[level] = static_cast<std::uint8_t>(draws.below(maps));
        }
    }

    std::uint64_t run(PlaneMaps& maps) {
        const double reach = fit_.reach_px * fit_.reach_px;
        double error = assign(maps, outer_) + inner_error(maps);
        double damping = 1e-2;
        PlaneMaps trial;
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
    struct Word {
        std::array<std::uint8_t, most_levels> letters{}; ///< the first is applied last
        Vec2 from{0.0};                                  ///< a point of the target
    };

    double robust(double squared) const {
        const double reach = fit_.reach_px * fit_.reach_px;
        return squared * reach / (squared + reach);
    }

    Vec2 image(const PlaneMaps& maps, const Word& word) const {
        Vec2 p = word.from;
        for (std::size_t level = levels_; level-- > 0;)
            p = maps[word.letters[level]](p);
        return p;
    }

    double inner_error(const PlaneMaps& maps) {
        double sum = 0;
        for (const Word& word : inner_) {
            const Vec2 p = image(maps, word);
            sum += robust(squared_length(p - target_.nearest(p)));
        }
        work_ += inner_.size() * levels_;
        return sum / static_cast<double>(inner_.size());
    }

    /// Finds the words of the outer points; returns their error.
    double assign(const PlaneMaps& maps, std::vector<Word>& words) {
        inverses_.clear();
        for (const PlaneMap& map : maps)
            inverses_.push_back(bounded_inverse(map, target_.centre(), 0.01));
        double sum = 0;
        for (std::size_t i = 0; i < words.size(); ++i) {
            Word& word = words[i];
            Vec2 p = points_.outer[i];
            for (std::size_t level = 0; level < levels_; ++level) {
                double least = 1e300;
                Vec2 before{0.0};
                for (std::size_t m = 0; m < maps.size(); ++m) {
                    const Vec2 source = inverses_[m](p);
                    const Vec2 known = target_.nearest(source);
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
    void add(const PlaneMaps& maps, const Word& word, Vec2 to, bool nearest, double weight, double reach) {
        std::array<Vec2, most_levels + 1> at;
        at[levels_] = word.from;
        for (std::size_t level = levels_; level-- > 0;)
            at[level] = maps[word.letters[level]](at[level + 1]);
        if (nearest) to = target_.nearest(at[0]);
        Vec2 direction = at[0] - to;
        const double squared = squared_length(direction);
        if (squared < 1e-18) return;
        const double distance = std::sqrt(squared), kept = reach / (squared + reach);
        weight *= kept * kept;
        direction /= distance;
        std::array<std::array<double, entries>, most_levels> slope;
        for (std::size_t level = 0; level < levels_; ++level) {
            const Vec2 arm = at[level + 1] - target_.centre();
            const PlaneMap& map = maps[word.letters[level]];
            slope[level] = {direction.x * arm.x, direction.x * arm.y, direction.x,
                            direction.y * arm.x, direction.y * arm.y, direction.y};
            direction = {map.a * direction.x + map.c * direction.y,
                         map.b * direction.x + map.d * direction.y};
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

    void gather(const PlaneMaps& maps, double reach) {
        normal_.clear(maps.size());
        for (const Word& word : inner_)
            add(maps, word, {}, true, 1 / static_cast<double>(inner_.size()), reach);
        for (std::size_t i = 0; i < outer_.size(); ++i)
            add(maps, outer_[i], points_.outer[i], false, 1 / static_cast<double>(outer_.size()), reach);
        work_ += (inner_.size() + outer_.size()) * levels_ * levels_;
    }

    const Target& target_;
    const FitPoints& points_;
    const LevelFit& fit_;
    const MapRules& rules_;
    std::size_t levels_;
    std::vector<Word> inner_, outer_;
    PlaneMaps inverses_;
    Normal normal_;
    std::uint64_t work_ = 0;
};

/// The growth of one map, for one length tau.
class MapGrowth {
  public:
    MapGrowth(const Target& target, std::span<const Vec2> inner, double tau_px, const MapRules& rules)
        : target_(target), inner_(inner), rules_(rules),
          scale_(1 / (static_cast<double>(inner.size()) * tau_px * tau_px)) {}

    std::uint64_t run(int iterations, PlaneMap& map) {
        double damping = 1e-2, value = value_of(map);
        PlaneMaps one(1, map), trial;
        Normal normal(1);
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
    static constexpr double growth = 0.05; ///< mu

    double value_of(const PlaneMap& map) {
        double sum = 0;
        for (const Vec2 p : inner_) {
            const Vec2 q = map(p);
            sum += squared_length(q - target_.nearest(q));
        }
        work_ += inner_.size();
        return sum * scale_ - growth * std::log(std::abs(map.determinant()) + 1e-9);
    }

    void gather(const PlaneMap& map, Normal& normal) {
        std::array<double, entries * entries> hessian{};
        std::array<double, entries> gradient{};
        for (const Vec2 p : inner_) {
            const Vec2 q = map(p);
            Vec2 direction = q - target_.nearest(q);
            const double squared = squared_length(direction);
            if (squared < 1e-18) continue;
            const double distance = std::sqrt(squared);
            direction /= distance;
            const Vec2 arm = p - target_.centre();
            const std::array<double, entries> slope = {direction.x * arm.x, direction.x * arm.y, direction.x,
                                                       direction.y * arm.x, direction.y * arm.y, direction.y};
            for (std::size_t i = 0; i < entries; ++i) {
                gradient[i] += slope[i] * distance;
                for (std::size_t j = 0; j < entries; ++j)
                    hessian[i * entries + j] += slope[i] * slope[j];
            }
        }
        work_ += inner_.size();
        double determinant = map.determinant();
        if (std::abs(determinant) < 1e-7) determinant = 1e-7;
        const std::array<double, entries> larger = {map.d / determinant,  -map.c / determinant, 0,
                                                    -map.b / determinant, map.a / determinant,  0};
        for (std::size_t i = 0; i < entries; ++i) {
            const auto row = static_cast<Eigen::Index>(i);
            normal.gradient[row] = 2 * scale_ * gradient[i] - growth * larger[i];
            for (std::size_t j = 0; j < entries; ++j)
                normal.hessian(row, static_cast<Eigen::Index>(j)) =
                    2 * scale_ * hessian[i * entries + j] + growth * larger[i] * larger[j];
        }
    }

    const Target& target_;
    std::span<const Vec2> inner_;
    const MapRules& rules_;
    double scale_;
    std::uint64_t work_ = 0;
};

} // namespace

PlaneMap ruled(const PlaneMap& map, const Target& target, const MapRules& rules) {
    const std::array<double, entries> still{};
    return moved(rules.similar ? nearest_similarity(map, target.centre()) : map, still.data(),
                 target.centre(), rules.most_stretch);
}

std::uint64_t grow(const Target& target, std::span<const Vec2> inner, std::span<const double> tau_px,
                   int iterations, const MapRules& rules, PlaneMap& map) {
    std::uint64_t work = 0;
    for (const double tau : tau_px)
        work += MapGrowth(target, inner, tau, rules).run(iterations, map);
    return work;
}

std::uint64_t refine(const Target& target, const FitPoints& points, const LevelFit& fit,
                     const MapRules& rules, Draws& draws, PlaneMaps& maps) {
    return Refinement(target, points, fit, rules, maps.size(), draws).run(maps);
}

} // namespace graftal
