#include "runtime/inverse/search.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "runtime/inverse/copies.h"

namespace graftal {

namespace {

/// The weight of the strict agreement. In space the cells are coarser, and have more neighbours that count.
template<typename Map> constexpr double strict_weight = Map::dimensions == 2 ? 0.1 : 0.4;
/// The strict agreement of a target that is found.
template<typename Map> constexpr double strict_enough = Map::dimensions == 2 ? 0 : 0.75;

template<typename Map> struct System {
    std::vector<Map> maps;
    double value = -1;
    SetAgreement agreement;
};

/// One task's own: nothing that others write.
template<typename Map> struct Task {
    AttractorPainterOf<Map>& painter;
    Draws draws;
    std::uint64_t work = 0;
};

template<typename Map> class Search {
  public:
    using Point = typename Map::Point;
    using Maps = std::vector<Map>;
    using System = graftal::System<Map>;
    using Task = graftal::Task<Map>;
    using SelfCopy = graftal::SelfCopy<Map>;

    Search(const TargetOf<Map>& target, const SearchOptionsOf<Map>& options, const Workers& workers,
           const CancelFlag& cancel, const std::function<void(const SearchProgress&)>& on_progress)
        : target_(target), options_(options), workers_(workers), cancel_(cancel), on_progress_(on_progress),
          copies_(target, options.rules), points_(target, options.seed),
          painters_(static_cast<std::size_t>(workers.count())) {}

    FoundSystemOf<Map> run() {
        keep({simplest()});
        if (!options_.start.empty()) keep({judged(options_.start)});
        for (const double until : {0.03, 0.1, 0.3}) {
            gather_copies(until);
            if (!solved()) cover();
        }
        while (going_on(0.8))
            round();
        polish();
        for (int batches = 0; fraction() < 1 && !cancel_.raised() && (!solved() || batches < 150); ++batches)
            climb();
        const System& best = lines_.front();
        return {best.maps, best.agreement, seconds()};
    }

  private:
    static constexpr std::size_t line_count = 6; ///< systems that are bettered side by side

    double seconds() const { return static_cast<double>(work_) * seconds_of_map; }
    double fraction() const { return seconds() / options_.seconds; }
    bool solved() const {
        return !lines_.empty() && lines_.front().agreement.tolerant >= 0.998 &&
               lines_.front().agreement.strict >= strict_enough<Map>;
    }
    bool going_on(double until) const { return fraction() < until && !solved() && !cancel_.raised(); }

    /// Runs tasks number 0 to count - 1, each with random numbers of its own.
    template<typename Work> void tasks(std::size_t count, const Work& work) {
        std::vector<std::uint64_t> costs(count);
        const CounterRandom random = CounterRandom(options_.seed).sequence(++batches_);
        workers_.for_each(count, [&](int worker, std::uint64_t number) {
            if (cancel_.raised()) return;
            std::unique_ptr<AttractorPainterOf<Map>>& painter = painters_[static_cast<std::size_t>(worker)];
            if (!painter) painter = std::make_unique<AttractorPainterOf<Map>>(target_);
            Task task{*painter, Draws(random, number)};
            work(task, static_cast<std::size_t>(number));
            costs[static_cast<std::size_t>(number)] = task.work;
        });
        for (const std::uint64_t cost : costs)
            work_ += cost;
        if (on_progress_)
            on_progress_(
                {std::min(1.0, fraction()), lines_.front().agreement.tolerant, lines_.front().maps.size()});
    }

    double value_of(const SetAgreement& agreement, std::size_t maps) const {
        return (1 - strict_weight<Map>)*agreement.tolerant + strict_weight<Map> * agreement.strict -
               0.004 * static_cast<double>(maps);
    }

    System judge(Task& task, Maps maps) const {
        System system;
        task.work += task.painter.draw(maps) / 2;
        system.agreement = task.painter.agreement();
        task.work += target_.points().size() / 4;
        system.value = value_of(system.agreement, maps.size());
        system.maps = std::move(maps);
        return system;
    }

    System judged(Maps maps) {
        System system;
        tasks(1, [&](Task& task, std::size_t) { system = judge(task, std::move(maps)); });
        return system;
    }

    /// One map that takes everything to the middle of the target: an answer for who interrupts at once.
    System simplest() {
        System system;
        const Point middle = target_.centre();
        system.maps = {Map::half().taking(middle, middle)};
        AttractorPainterOf<Map> painter(target_);
        painter.draw(system.maps);
        system.agreement = painter.agreement();
        system.value = value_of(system.agreement, 1);
        return system;
    }

    /// Keeps the best systems, without repetitions.
    void keep(std::vector<System> systems) {
        for (System& system : systems)
            if (!system.maps.empty()) lines_.push_back(std::move(system));
        std::stable_sort(lines_.begin(), lines_.end(),
                         [](const System& a, const System& b) { return a.value > b.value; });
        const auto same = [](const System& a, const System& b) { return std::abs(a.value - b.value) < 1e-7; };
        lines_.erase(std::unique(lines_.begin(), lines_.end(), same), lines_.end());
        if (lines_.size() > line_count) lines_.resize(line_count);
    }

    /// Tasks that each may find a copy; adds those to the pool.
    template<typename Find> void find_copies(std::size_t count, const Find& find) {
        std::vector<std::optional<SelfCopy>> copies(count);
        tasks(count, [&](Task& task, std::size_t i) { copies[i] = find(task, i); });
        for (std::optional<SelfCopy>& copy : copies)
            if (copy) pool_.push_back(std::move(*copy));
        work_ += pool_.size() * target_.samples().size() / 16;
        pool_ = distinct(std::move(pool_), target_, 500);
    }

    void gather_copies(double until) {
        constexpr std::size_t starts = 256, climbs = 96;
        while (going_on(until)) {
            std::vector<SelfCopy> before;
            before.swap(pool_);
            find_copies(starts, [&](Task& task, std::size_t) { return copies_.find(task.draws, task.work); });
            const std::vector<SelfCopy> fresh = pool_;
            pool_.insert(pool_.end(), before.begin(), before.end());
            find_copies(std::min(climbs, fresh.size()), [&](Task& task, std::size_t i) {
                return copies_.climb(fresh[i].map, {}, task.draws, task.work);
            });
        }
    }

    /// The better of the system and its refinement by words of so many maps.
    void refine_to(Task& task, System& system, int levels, int iterations, double reach_px) const {
        Maps maps = system.maps;
        task.work += refine(target_, points_.of(levels), {levels, iterations, reach_px}, options_.rules,
                            task.draws, maps);
        System refined = judge(task, std::move(maps));
        if (refined.value > system.value) system = std::move(refined);
    }

    void cover() {
        const std::vector<Maps> collages = covers(pool_, target_, options_.most_maps, 48);
        work_ += 40 * options_.most_maps * pool_.size() * target_.samples().size() / 64 / 16;
        std::vector<System> systems(collages.size());
        tasks(collages.size(), [&](Task& task, std::size_t i) {
            systems[i] = judge(task, collages[i]);
            refine_to(task, systems[i], 1, 15, 4);
        });
        keep(std::move(systems));
    }

    /// Samples that lie in no image of the target under the maps.
    SampleSet missed_by(Task& task, const Maps& maps) const {
        SampleSet covered((target_.samples().size() + 63) / 64, 0);
        for (const Map& map : maps) {
            const SampleSet more = covered_by(map, target_);
            for (std::size_t i = 0; i < more.size(); ++i)
                covered[i] |= more[i];
        }
        task.work += maps.size() * target_.samples().size();
        for (std::size_t i = 0; i < covered.size(); ++i)
            covered[i] = ~covered[i];
        if (const std::size_t rest = target_.samples().size() % 64)
            covered.back() &= (std::uint64_t{1} << rest) - 1;
        return covered;
    }

    /// Samples that the attractor does not reach.
    SampleSet unreached(Task& task, const Maps& maps) const {
        task.work += task.painter.draw(maps) / 2;
        SampleSet missed((target_.samples().size() + 63) / 64, 0);
        for (std::size_t i = 0; i < target_.samples().size(); ++i)
            if (!task.painter.reaches(target_.samples()[i])) missed[i / 64] |= std::uint64_t{1} << (i % 64);
        return missed;
    }

    using Ranked = std::vector<std::pair<double, SelfCopy>>;

    /// Keeps the best few, the best first.
    static void cut(Ranked& ranked, std::size_t most) {
        std::stable_sort(ranked.begin(), ranked.end(),
                         [](const auto& a, const auto& b) { return a.first > b.first; });
        if (ranked.size() > most) ranked.resize(most);
    }

    /// The copies that cover most of what is missed: of the pool or grown for it, and then moved towards it.
    Ranked copies_for(Task& task, const SampleSet& missed, std::size_t most) const {
        constexpr std::size_t starts = 32, climbs = 5, most_wanted = 300;
        std::vector<Point> places, wanted;
        for (std::size_t i = 0; i < target_.samples().size(); ++i)
            if (missed[i / 64] >> (i % 64) & 1) places.push_back(target_.samples()[i]);
        if (places.empty()) return {};
        const auto rank = [&](const SelfCopy& copy) {
            std::size_t fresh = 0;
            for (std::size_t i = 0; i < missed.size(); ++i)
                fresh += static_cast<std::size_t>(std::popcount(missed[i] & copy.covered[i]));
            return static_cast<double>(fresh) - 1.5 * copy.bad * static_cast<double>(copy.count);
        };
        Ranked ranked;
        for (std::size_t i = 0; i < starts; ++i) {
            const Point place = places[task.draws.below(places.size())];
            std::optional<SelfCopy> copy = copies_.find(task.draws, task.work, &place);
            if (copy) ranked.emplace_back(rank(*copy), std::move(*copy));
        }
        for (const SelfCopy& copy : pool_)
            if (task.draws.unit() < 0.3) ranked.emplace_back(rank(copy), copy);
        cut(ranked, climbs);
        for (std::size_t i = 0; i < std::min(most_wanted, places.size()); ++i)
            wanted.push_back(places[task.draws.below(places.size())]);
        for (std::size_t i = ranked.size(); i-- > 0;) {
            std::optional<SelfCopy> copy = copies_.climb(ranked[i].second.map, wanted, task.draws, task.work);
            if (copy) ranked.emplace_back(rank(*copy), std::move(*copy));
        }
        cut(ranked, most);
        return ranked;
    }

    /// The system after one change and a refinement, if it can be changed so.
    System changed(Task& task, const System& system) const {
        const std::size_t count = system.maps.size();
        const double kind = task.draws.unit();
        Maps rest = system.maps;
        SampleSet missed;
        if (count == 1 || (kind < 0.4 && count < options_.most_maps)) {
            missed = unreached(task, rest);
        } else {
            rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(task.draws.below(count)));
            if (kind > 0.75 && count > 2)
                rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(task.draws.below(count - 1)));
            missed = missed_by(task, rest);
        }
        System best;
        for (const auto& [gain, copy] : copies_for(task, missed, 2)) {
            Maps maps = rest;
            maps.push_back(copy.map);
            task.work += refine(target_, points_.of(1), {1, 10, 4}, options_.rules, task.draws, maps);
            System tried = judge(task, std::move(maps));
            if (tried.value > best.value) best = std::move(tried);
        }
        if (best.value < system.value - 0.03) return best;
        refine_to(task, best, 2, 8, 4);
        refine_to(task, best, 4, 6, 3);
        thin(task, best);
        return best;
    }

    /// Drops maps that the system is no worse without.
    void thin(Task& task, System& system) const {
        for (std::size_t i = system.maps.size(); i-- > 0 && system.maps.size() > 2;) {
            Maps maps = system.maps;
            maps.erase(maps.begin() + static_cast<std::ptrdiff_t>(i));
            System thinner = judge(task, std::move(maps));
            if (thinner.value > system.value) system = std::move(thinner);
        }
    }

    void round() {
        constexpr std::size_t batch = 8;
        std::vector<System> systems(batch);
        const std::size_t lines = lines_.size();
        tasks(batch, [&](Task& task, std::size_t i) {
            systems[i] = changed(task, lines_[i < batch / 2 ? 0 : i % lines]);
        });
        keep(std::move(systems));
        ++work_; // a round without a change ends, too
    }

    /// Moves the best system from covering the target to having it for its attractor.
    void polish() {
        System best = lines_.front();
        tasks(1, [&](Task& task, std::size_t) {
            for (const auto& [levels, reach_px] : {std::pair(2, 3.0), std::pair(4, 2.0), std::pair(6, 1.5)})
                refine_to(task, best, levels, 10, reach_px);
        });
        keep({std::move(best)});
    }

    /// Steps of the best system at random, one map at a time, with what they come to.
    void climb() {
        constexpr std::size_t batch = 8;
        const System& best = lines_.front();
        std::vector<System> systems(batch);
        tasks(batch, [&](Task& task, std::size_t i) {
            Maps maps = best.maps;
            const double size = step_ * std::exp(task.draws.normal());
            Map& map = maps[(i + batches_) % maps.size()];
            std::array<double, Map::entries> step;
            for (std::size_t k = 0; k < step.size(); ++k)
                step[k] = size * task.draws.normal() *
                          (k % (Map::dimensions + 1) == Map::dimensions ? 0.5 * target_.spread() : 1);
            map = ruled(moved(map, step.data(), target_.centre(), options_.rules.most_stretch), target_,
                        options_.rules);
            systems[i] = judge(task, std::move(maps));
        });
        const double before = best.value;
        keep(std::move(systems));
        step_ = std::clamp(step_ * (lines_.front().value > before ? 1.3 : 0.93), 3e-4, 0.03);
    }

    const TargetOf<Map>& target_;
    const SearchOptionsOf<Map>& options_;
    const Workers& workers_;
    const CancelFlag& cancel_;
    const std::function<void(const SearchProgress&)>& on_progress_;
    CopySearch<Map> copies_;
    LevelPoints<Map> points_;
    std::vector<std::unique_ptr<AttractorPainterOf<Map>>> painters_;
    std::vector<SelfCopy> pool_;
    std::vector<System> lines_; ///< best first
    double step_ = 0.01;        ///< of the random steps
    std::uint64_t batches_ = 0, work_ = 0;
};

} // namespace

template<typename Map>
FoundSystemOf<Map> search(const TargetOf<Map>& target, const SearchOptionsOf<Map>& options,
                          const Workers& workers, const CancelFlag& cancel,
                          const std::function<void(const SearchProgress&)>& on_progress) {
    return Search<Map>(target, options, workers, cancel, on_progress).run();
}

#define GRAFTAL_SEARCH(Map)                                                                                  \
    template FoundSystemOf<Map> search(const TargetOf<Map>&, const SearchOptionsOf<Map>&, const Workers&,    \
                                       const CancelFlag&,                                                    \
                                       const std::function<void(const SearchProgress&)>&);
GRAFTAL_SEARCH(PlaneMap)
GRAFTAL_SEARCH(SpaceMap)
#undef GRAFTAL_SEARCH

} // namespace graftal
