#include "runtime/inverse/map_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace graftal {

namespace {

constexpr double snapping_share = 0.8; ///< of the work
constexpr double near_enough = 0.998;  ///< agreement within a cell

} // namespace

MapFit::MapFit(const Target& target, PlaneMaps start, double seconds, std::uint64_t seed)
    : target_(target), copies_(target, rules_), most_seconds_(seconds), seed_(seed), points_(target, seed) {
    AttractorPainter painter(target);
    best_ = judged(painter, std::move(start), work_);
}

double MapFit::seconds() const {
    return static_cast<double>(work_) * seconds_of_map;
}

double MapFit::fraction() const {
    return std::min(1.0, seconds() / most_seconds_);
}

bool MapFit::step(const Workers& workers, const CancelFlag& cancel) {
    constexpr int most_stalled = 150;
    if (cancel.raised() || fraction() >= 1 || stalled_ >= most_stalled) return false;
    if (stalled_ == 0 && fraction() < snapping_share)
        snap_maps(workers);
    else
        climb(workers);
    ++work_; // a piece without a change ends, too
    stalled_ += best_.agreement.tolerant >= near_enough;
    return true;
}

/// Runs tasks number 0 to count - 1, each with random numbers of its own; a task returns its work.
template<typename Work> void MapFit::tasks(std::size_t count, const Workers& workers, const Work& work) {
    std::vector<std::uint64_t> costs(count);
    painters_.resize(std::max(painters_.size(), static_cast<std::size_t>(workers.count())));
    const CounterRandom random = CounterRandom(seed_).sequence(++batches_);
    workers.for_each(count, [&](int worker, std::uint64_t number) {
        std::unique_ptr<AttractorPainter>& painter = painters_[static_cast<std::size_t>(worker)];
        if (!painter) painter = std::make_unique<AttractorPainter>(target_);
        Draws draws(random, number);
        costs[static_cast<std::size_t>(number)] = work(static_cast<std::size_t>(number), *painter, draws);
    });
    for (const std::uint64_t cost : costs)
        work_ += cost;
}

MapFit::System MapFit::judged(AttractorPainter& painter, PlaneMaps maps, std::uint64_t& work) const {
    System system;
    constexpr std::uint64_t work_of_judging = 200;
    work += painter.draw(maps) / 2 + target_.points().size() / 4 + work_of_judging;
    system.agreement = painter.agreement();
    system.value = 0.9 * system.agreement.tolerant + 0.1 * system.agreement.strict;
    system.maps = std::move(maps);
    return system;
}

void MapFit::keep(std::vector<System> systems) {
    for (System& system : systems)
        if (system.value > best_.value) best_ = std::move(system);
}

/// Moves the map to a copy of the target near it that reaches the points of the edge that are nearest to its
/// image among all maps' images.
std::uint64_t MapFit::snap(PlaneMaps& maps, std::size_t which, Draws& draws) const {
    std::vector<Vec2> own;
    PlaneMaps backs;
    for (const PlaneMap& map : maps)
        backs.push_back(bounded_inverse(map, target_.centre(), 0.01));
    const std::vector<Vec2> edge = target_.drawn_edge(1000, draws);
    for (const Vec2 p : edge) {
        double least = std::numeric_limits<double>::infinity();
        std::size_t nearest = 0;
        for (std::size_t i = 0; i < maps.size(); ++i) {
            const Vec2 away = maps[i](target_.nearest(backs[i](p))) - p;
            const double squared = away.x * away.x + away.y * away.y;
            if (squared >= least) continue;
            least = squared;
            nearest = i;
        }
        if (nearest == which) own.push_back(p);
    }
    std::uint64_t work = edge.size() * maps.size();
    if (own.empty()) return work;
    const std::optional<SelfCopy<PlaneMap>> copy = copies_.climb(maps[which], own, draws, work);
    if (copy) maps[which] = copy->map;
    return work;
}

/// Moves one map of the best system, or several, to copies, and refines all: by points from near and far, and
/// by words of two and four maps.
void MapFit::snap_maps(const Workers& workers) {
    constexpr std::size_t batch = 4;
    std::vector<System> systems(batch);
    tasks(batch, workers, [&](std::size_t i, AttractorPainter& painter, Draws& draws) {
        PlaneMaps maps = best_.maps;
        for (PlaneMap& map : maps) // those of the start, too
            map = ruled(map, target_, rules_);
        std::uint64_t work = 0;
        const std::size_t first = draws.below(maps.size());
        for (std::size_t k = 0; k < maps.size(); ++k)
            if (k == 0 || i == 0 || draws.unit() < 0.3) work += snap(maps, (first + k) % maps.size(), draws);
        const double reach_px = std::ldexp(4.0, static_cast<int>(i));
        for (const LevelFit& fit :
             {LevelFit{1, 10, reach_px}, LevelFit{1, 10, 4}, LevelFit{2, 8, 4}, LevelFit{4, 6, 3}})
            work += refine(target_, points_.of(fit.levels), fit, rules_, draws, maps);
        systems[i] = judged(painter, std::move(maps), work);
        return work;
    });
    keep(std::move(systems));
}

/// Random steps of the best system, one map at a time.
void MapFit::climb(const Workers& workers) {
    constexpr std::size_t batch = 8;
    std::vector<System> systems(batch);
    tasks(batch, workers, [&](std::size_t i, AttractorPainter& painter, Draws& draws) {
        PlaneMaps maps = best_.maps;
        const double size = step_ * std::exp(draws.normal());
        const std::size_t moving = (i + batches_) % maps.size();
        std::array<double, 6> change;
        for (std::size_t k = 0; k < change.size(); ++k)
            change[k] = size * draws.normal() * (k % 3 == 2 ? 0.5 * target_.spread() : 1);
        maps[moving] = moved(maps[moving], change.data(), target_.centre(), rules_.most_stretch);
        for (PlaneMap& map : maps) // those of the start, too
            map = ruled(map, target_, rules_);
        std::uint64_t work = 0;
        systems[i] = judged(painter, std::move(maps), work);
        return work;
    });
    const double before = best_.value;
    keep(std::move(systems));
    step_ = std::clamp(step_ * (best_.value > before ? 1.3 : 0.93), 3e-4, 0.03);
}

} // namespace graftal
