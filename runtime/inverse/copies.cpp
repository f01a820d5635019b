#include "runtime/inverse/copies.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <utility>

namespace graftal {

namespace {

double length(Vec2 v) {
    return std::sqrt(v.x * v.x + v.y * v.y);
}

double rank_of(const SelfCopy& copy) {
    return static_cast<double>(copy.count) * (1 - 3 * copy.bad);
}

bool repeats(const SelfCopy& copy, const SelfCopy& other, const Target& target) {
    double apart = 0;
    const Vec2 centre = target.centre();
    for (const Vec2 arm : {Vec2(0, 0), Vec2(2, 0), Vec2(0, 2)}) {
        const Vec2 p = centre + target.spread() * arm;
        apart = std::max(apart, length(copy.map(p) - other.map(p)));
    }
    if (apart < 3) return true;
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
std::vector<PartialCover> longer(const std::vector<PartialCover>& covers, const std::vector<SelfCopy>& copies,
                                 double samples, std::size_t beam) {
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

SampleSet covered_by(const PlaneMap& map, const Target& target, double reach_px) {
    const std::span<const Vec2> samples = target.samples();
    SampleSet set((samples.size() + 63) / 64, 0);
    const PlaneMap back = bounded_inverse(map, target.centre(), 0.01);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const Vec2 away = map(target.nearest(back(samples[i]))) - samples[i];
        if (away.x * away.x + away.y * away.y <= reach_px * reach_px)
            set[i / 64] |= std::uint64_t{1} << (i % 64);
    }
    return set;
}

CopySearch::CopySearch(const Target& target, const MapRules& rules) : target_(target), rules_(rules) {
    Draws draws(CounterRandom(2), 0);
    coarse_ = target.drawn(120, draws);
    points_ = {target.drawn(400, draws), target.drawn_edge(300, draws)};
}

double CopySearch::outside(const PlaneMap& map, std::span<const Vec2> points, double& mean_px) const {
    double sum = 0;
    std::size_t bad = 0;
    for (const Vec2 p : points) {
        const Vec2 q = map(p);
        const double away = length(q - target_.nearest(q));
        sum += std::min(away, 8.0);
        bad += away > 1.6;
    }
    mean_px = sum / static_cast<double>(points.size());
    return static_cast<double>(bad) / static_cast<double>(points.size());
}

std::optional<SelfCopy> CopySearch::find(Draws& draws, std::uint64_t& work, const Vec2* where) const {
    constexpr double pi = std::numbers::pi;
    constexpr std::array<double, 2> coarse_tau_px = {16, 6};
    constexpr std::array<double, 3> fine_tau_px = {3, 1.5, 0.5};
    const double least = where ? 0.05 : 0.12, most = 0.85;
    PlaneStretch stretch;
    stretch.largest = std::exp(draws.between(std::log(least), std::log(most)));
    stretch.least = stretch.largest * std::exp(-0.3 * std::abs(draws.normal()));
    if (where && draws.unit() < 0.15) stretch.least *= 0.02; // such as the stem of a fern
    if (rules_.similar) stretch.least = stretch.largest;
    if (draws.unit() < 0.5) stretch.least = -stretch.least;
    stretch.left_rad = draws.between(-pi, pi);
    stretch.right_rad = draws.between(-pi, pi);
    const std::vector<Vec2>& points = target_.points();
    const Vec2 from = points[draws.below(points.size())];
    SelfCopy copy;
    copy.map = map_of(stretch, from, where ? *where : points[draws.below(points.size())]);
    work += grow(target_, coarse_, coarse_tau_px, 8, rules_, copy.map);
    double mean_px = 0;
    outside(copy.map, coarse_, mean_px);
    if (mean_px > 4.5) return std::nullopt;
    work += grow(target_, points_.inner, fine_tau_px, 6, rules_, copy.map) + coarse_.size();
    return snapped(copy.map, 4, draws, work);
}

double CopySearch::merit(const PlaneMap& map, std::span<const Vec2> wanted, double reach_px,
                         std::uint64_t& work) const {
    const double squared_reach = reach_px * reach_px;
    const auto share = [&](Vec2 away) {
        return std::min(1.0, (away.x * away.x + away.y * away.y) / squared_reach);
    };
    const PlaneMap back = bounded_inverse(map, target_.centre(), 0.01);
    double missed = 0, outside = 0;
    for (const Vec2 p : wanted)
        missed += share(map(target_.nearest(back(p))) - p);
    for (const Vec2 p : coarse_) {
        const Vec2 q = map(p);
        outside += share(q - target_.nearest(q));
    }
    work += wanted.size() + coarse_.size();
    return 1 - missed / static_cast<double>(wanted.size()) -
           1.5 * outside / static_cast<double>(coarse_.size());
}

std::optional<SelfCopy> CopySearch::climb(const PlaneMap& map, std::span<const Vec2> wanted, Draws& draws,
                                          std::uint64_t& work) const {
    if (wanted.empty()) wanted = points_.outer;
    PlaneMap best = map;
    double size_px = 8;
    constexpr int steps = 150;
    for (const double reach_px : {8.0, 4.0, 2.0}) {
        double merit_of_best = merit(best, wanted, reach_px, work);
        for (int i = 0; i < steps; ++i) {
            const double entry = size_px / (2 * target_.spread());
            std::array<double, 6> step;
            for (std::size_t k = 0; k < step.size(); ++k)
                step[k] = draws.normal() * (k % 3 == 2 ? 0.7 * size_px : entry);
            const PlaneMap tried =
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

std::optional<SelfCopy> CopySearch::snapped(const PlaneMap& map, double reach_px, Draws& draws,
                                            std::uint64_t& work) const {
    PlaneMaps one(1, map);
    for (; reach_px >= 2; reach_px /= 2)
        work += refine(target_, points_, {1, 6, reach_px}, rules_, draws, one);
    SelfCopy copy;
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

std::vector<SelfCopy> distinct(std::vector<SelfCopy> copies, const Target& target, std::size_t most) {
    std::stable_sort(copies.begin(), copies.end(),
                     [](const SelfCopy& a, const SelfCopy& b) { return rank_of(a) > rank_of(b); });
    std::vector<SelfCopy> result;
    for (SelfCopy& copy : copies) {
        const auto same = [&](const SelfCopy& better) { return repeats(copy, better, target); };
        if (std::any_of(result.begin(), result.end(), same)) continue;
        result.push_back(std::move(copy));
        if (result.size() == most) break;
    }
    return result;
}

std::vector<PlaneMaps> covers(const std::vector<SelfCopy>& copies, const Target& target,
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
    std::vector<PlaneMaps> result;
    for (const PartialCover& cover : found) {
        result.emplace_back();
        for (const std::uint16_t i : cover.chosen)
            result.back().push_back(copies[i].map);
    }
    return result;
}

} // namespace graftal
