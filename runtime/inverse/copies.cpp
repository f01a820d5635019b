#include "runtime/inverse/copies.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

namespace graftal {

namespace {

template<typename Map> double rank_of(const SelfCopy<Map>& copy) {
    return static_cast<double>(copy.count) * (1 - 3 * copy.bad);
}

template<typename Map>
bool repeats(const SelfCopy<Map>& copy, const SelfCopy<Map>& other, const TargetOf<Map>& target) {
    const typename Map::Point centre = target.centre();
    double apart = glm::length(copy.map(centre) - other.map(centre));
    for (int k = 0; k < centre.length(); ++k) {
        typename Map::Point p = centre;
        p[k] += 2 * target.spread();
        apart = std::max(apart, glm::length(copy.map(p) - other.map(p)));
    }
    if (apart < 3 * target.fineness) return true;
    std::size_t both = 0, either = 0;
    for (std::size_t i = 0; i < copy.covered.size(); ++i) {
        both += static_cast<std::size_t>(std::popcount(copy.covered[i] & other.covered[i]));
        either += static_cast<std::size_t>(std::popcount(copy.covered[i] | other.covered[i]));
    }
    return static_cast<double>(both) > 0.95 * static_cast<double>(either);
}

struct PartialCover {
    std::vector<std::uint16_t> chosen; ///< in order
    SampleSet covered;
    double cost = 1;
};

/// The covers with one copy more: the best few for each.
template<typename Map>
std::vector<PartialCover> longer(const std::vector<PartialCover>& covers,
                                 const std::vector<SelfCopy<Map>>& copies, double samples, std::size_t beam) {
    constexpr double price_of_map = 0.012;
    std::vector<PartialCover> result;
    for (const PartialCover& cover : covers) {
        std::vector<std::pair<double, std::uint16_t>> gains;
        for (std::size_t i = 0; i < copies.size(); ++i) {
            std::size_t fresh = 0;
            for (std::size_t k = 0; k < cover.covered.size(); ++k)
                fresh += static_cast<std::size_t>(std::popcount(copies[i].covered[k] & ~cover.covered[k]));
            if (static_cast<double>(fresh) < 0.004 * samples) continue;
            gains.emplace_back(1.5 * copies[i].bad * static_cast<double>(copies[i].count) -
                                   static_cast<double>(fresh),
                               static_cast<std::uint16_t>(i));
        }
        const auto end = gains.begin() + static_cast<std::ptrdiff_t>(std::min(beam, gains.size()));
        std::partial_sort(gains.begin(), end, gains.end());
        for (auto gain = gains.begin(); gain != end; ++gain) {
            PartialCover next = cover;
            next.chosen.insert(std::upper_bound(next.chosen.begin(), next.chosen.end(), gain->second),
                               gain->second);
            const SampleSet& more = copies[gain->second].covered;
            for (std::size_t k = 0; k < more.size(); ++k)
                next.covered[k] |= more[k];
            double bad = 0;
            for (const std::uint16_t i : next.chosen)
                bad += copies[i].bad * static_cast<double>(copies[i].count);
            next.cost = 1 - (static_cast<double>(count_of(next.covered)) - bad) / samples +
                        price_of_map * static_cast<double>(next.chosen.size());
            result.push_back(std::move(next));
        }
    }
    const auto better = [](const PartialCover& a, const PartialCover& b) {
        return a.cost != b.cost ? a.cost < b.cost : a.chosen < b.chosen;
    };
    std::sort(result.begin(), result.end(), better);
    const auto same = [](const PartialCover& a, const PartialCover& b) { return a.chosen == b.chosen; };
    result.erase(std::unique(result.begin(), result.end(), same), result.end());
    if (result.size() > beam) result.resize(beam);
    return result;
}

} // namespace

std::size_t count_of(const SampleSet& set) {
    std::size_t count = 0;
    for (const std::uint64_t bits : set)
        count += static_cast<std::size_t>(std::popcount(bits));
    return count;
}

template<typename Map> SampleSet covered_by(const Map& map, const TargetOf<Map>& target, double reach_px) {
    const std::span<const typename Map::Point> samples = target.samples();
    SampleSet set((samples.size() + 63) / 64, 0);
    const Map back = bounded_inverse(map, target.centre(), 0.01);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const typename Map::Point away = map(target.nearest(back(samples[i]))) - samples[i];
        if (glm::dot(away, away) <= reach_px * reach_px) set[i / 64] |= std::uint64_t{1} << (i % 64);
    }
    return set;
}

template<typename Map>
CopySearch<Map>::CopySearch(const TargetOf<Map>& target, const MapRules& rules)
    : target_(target), rules_(rules) {
    Draws draws(CounterRandom(2), 0);
    coarse_ = target.drawn(120, draws);
    points_ = {target.drawn(400, draws), target.drawn_edge(300, draws)};
}

template<typename Map>
double CopySearch<Map>::outside(const Map& map, std::span<const Point> points, double& mean_px) const {
    double sum = 0;
    std::size_t bad = 0;
    for (const Point p : points) {
        const Point q = map(p);
        const double away = glm::length(q - target_.nearest(q));
        sum += std::min(away, 8.0);
        bad += away > target_.beside;
    }
    mean_px = sum / static_cast<double>(points.size());
    return static_cast<double>(bad) / static_cast<double>(points.size());
}

template<typename Map>
Map CopySearch<Map>::first_map(Draws& draws, std::uint64_t& work, const Point* where) const {
    // Space has many more directions than the plane, so that a look at a few points pays before a map grows.
    constexpr int tries = Map::dimensions == 2 ? 1 : 24;
    constexpr std::size_t looked_at = 30;
    const std::vector<Point>& points = target_.points();
    Map best;
    double least = 1e300;
    for (int i = 0; i < tries; ++i) {
        const Map linear = Map::random(where != nullptr, rules_.similar, draws);
        const Point from = points[draws.below(points.size())];
        const Map map = linear.taking(from, where ? *where : points[draws.below(points.size())]);
        if (tries == 1) return map;
        const double value = growth_value(target_, std::span(coarse_).first(looked_at), 8, map);
        if (value < least) {
            least = value;
            best = map;
        }
    }
    work += tries * looked_at;
    return best;
}

template<typename Map>
std::optional<SelfCopy<Map>> CopySearch<Map>::find(Draws& draws, std::uint64_t& work,
                                                   const Point* where) const {
    const std::array<double, 2> coarse_tau_px = {16 * target_.fineness, 6 * target_.fineness};
    const std::array<double, 3> fine_tau_px = {3 * target_.fineness, 1.5 * target_.fineness, 0.5};
    SelfCopy<Map> copy;
    copy.map = first_map(draws, work, where);
    work += grow(target_, coarse_, coarse_tau_px, 8, rules_, copy.map);
    double mean_px = 0;
    outside(copy.map, coarse_, mean_px);
    if (mean_px > 4.5 * target_.fineness) return std::nullopt;
    work += grow(target_, points_.inner, fine_tau_px, 6, rules_, copy.map) + coarse_.size();
    return snapped(copy.map, 4, draws, work);
}

template<typename Map>
double CopySearch<Map>::merit(const Map& map, std::span<const Point> wanted, double reach_px,
                              std::uint64_t& work) const {
    const double squared_reach = reach_px * reach_px;
    const auto share = [&](Point away) { return std::min(1.0, glm::dot(away, away) / squared_reach); };
    const Map back = bounded_inverse(map, target_.centre(), 0.01);
    double missed = 0, outside = 0;
    for (const Point p : wanted)
        missed += share(map(target_.nearest(back(p))) - p);
    for (const Point p : coarse_) {
        const Point q = map(p);
        outside += share(q - target_.nearest(q));
    }
    work += wanted.size() + coarse_.size();
    return 1 - missed / static_cast<double>(wanted.size()) -
           1.5 * outside / static_cast<double>(coarse_.size());
}

template<typename Map>
std::optional<SelfCopy<Map>> CopySearch<Map>::climb(const Map& map, std::span<const Point> wanted,
                                                    Draws& draws, std::uint64_t& work) const {
    if (wanted.empty()) wanted = points_.outer;
    Map best = map;
    double size_px = 8 * target_.fineness;
    constexpr int steps = 150;
    for (const double scale : {8.0, 4.0, 2.0}) {
        const double reach_px = std::max(1.5, scale * target_.fineness);
        double merit_of_best = merit(best, wanted, reach_px, work);
        for (int i = 0; i < steps; ++i) {
            const double entry = size_px / (2 * target_.spread());
            std::array<double, Map::entries> step;
            for (std::size_t k = 0; k < step.size(); ++k)
                step[k] =
                    draws.normal() * (k % (Map::dimensions + 1) == Map::dimensions ? 0.7 * size_px : entry);
            const Map tried =
                ruled(moved(best, step.data(), target_.centre(), rules_.most_stretch), target_, rules_);
            const double now = merit(tried, wanted, reach_px, work);
            if (now > merit_of_best) {
                best = tried;
                merit_of_best = now;
                size_px = std::min(16.0, 1.6 * size_px);
            } else {
                size_px = std::max(0.2, 0.93 * size_px);
            }
        }
    }
    return snapped(best, 2, draws, work);
}

template<typename Map>
std::optional<SelfCopy<Map>> CopySearch<Map>::snapped(const Map& map, double reach_px, Draws& draws,
                                                      std::uint64_t& work) const {
    std::vector<Map> one(1, map);
    for (; reach_px >= 2; reach_px /= 2)
        work += refine(target_, points_, {1, 6, reach_px}, rules_, draws, one);
    SelfCopy<Map> copy;
    copy.map = one.front();
    double mean_px = 0;
    copy.bad = outside(copy.map, points_.inner, mean_px);
    work += points_.inner.size();
    if (copy.bad > 0.08) return std::nullopt;
    copy.covered = covered_by(copy.map, target_);
    copy.count = count_of(copy.covered);
    work += target_.samples().size();
    return copy;
}

template<typename Map>
std::vector<SelfCopy<Map>> distinct(std::vector<SelfCopy<Map>> copies, const TargetOf<Map>& target,
                                    std::size_t most) {
    std::stable_sort(copies.begin(), copies.end(),
                     [](const SelfCopy<Map>& a, const SelfCopy<Map>& b) { return rank_of(a) > rank_of(b); });
    std::vector<SelfCopy<Map>> result;
    for (SelfCopy<Map>& copy : copies) {
        const auto same = [&](const SelfCopy<Map>& better) { return repeats(copy, better, target); };
        if (std::any_of(result.begin(), result.end(), same)) continue;
        result.push_back(std::move(copy));
        if (result.size() == most) break;
    }
    return result;
}

template<typename Map>
std::vector<std::vector<Map>> covers(const std::vector<SelfCopy<Map>>& copies, const TargetOf<Map>& target,
                                     std::size_t most_maps, std::size_t most_covers) {
    constexpr std::size_t beam = 40;
    const auto samples = static_cast<double>(target.samples().size());
    std::vector<PartialCover> found, current(1);
    current.front().covered.assign((target.samples().size() + 63) / 64, 0);
    for (std::size_t maps = 1; maps <= most_maps && !current.empty(); ++maps) {
        current = longer(current, copies, samples, beam);
        if (maps > 1) found.insert(found.end(), current.begin(), current.end());
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const PartialCover& a, const PartialCover& b) { return a.cost < b.cost; });
    if (found.size() > most_covers) found.resize(most_covers);
    std::vector<std::vector<Map>> result;
    for (const PartialCover& cover : found) {
        result.emplace_back();
        for (const std::uint16_t i : cover.chosen)
            result.back().push_back(copies[i].map);
    }
    return result;
}

// NOLINTBEGIN(bugprone-macro-parentheses): a type in brackets is none
#define GRAFTAL_COPIES(Map)                                                                                  \
    template class CopySearch<Map>;                                                                          \
    template SampleSet covered_by(const Map&, const TargetOf<Map>&, double);                                 \
    template std::vector<SelfCopy<Map>> distinct(std::vector<SelfCopy<Map>>, const TargetOf<Map>&,           \
                                                 std::size_t);                                               \
    template std::vector<std::vector<Map>> covers(const std::vector<SelfCopy<Map>>&, const TargetOf<Map>&,   \
                                                  std::size_t, std::size_t);
GRAFTAL_COPIES(PlaneMap)
GRAFTAL_COPIES(SpaceMap)
#undef GRAFTAL_COPIES
// NOLINTEND(bugprone-macro-parentheses)

} // namespace graftal
