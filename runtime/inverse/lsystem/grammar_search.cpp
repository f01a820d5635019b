#include "runtime/inverse/lsystem/grammar_search.h"

#include <algorithm>
#include <cstdint>

namespace graftal {

namespace {

constexpr int most_rounds = 9;
constexpr int rich_round = 2; ///< the first with rich systems
constexpr std::uint64_t first_modules = 250'000, rich_modules = 1'200, least_modules = 300;
constexpr std::size_t least_rich_size = 8;

/// Modules for a growth in a round, at all starts together: more for the smallest of the plain systems.
std::uint64_t modules_for(std::size_t place, bool rich, int round) {
    const std::uint64_t modules = rich ? rich_modules : first_modules / (place + 20);
    return std::max(least_modules, modules << (3 * (rich ? round - rich_round : round)));
}

class GrammarSearch {
  public:
    GrammarSearch(const StrokeGraph& graph, WorkMeter& meter)
        : graph_(graph), meter_(meter), unfolding_(graph, meter) {}

    std::optional<FoundGrammar> run(const std::function<void(double, int)>& on_progress) {
        add(false);
        for (int round = 0; round < most_rounds && !best_; ++round) {
            try_round(0, round, on_progress);
            // After a find, too, to see that no smaller one is among them.
            const bool may_be_smaller = best_ && round < rich_round && best_->growth.size() > least_rich_size;
            if (round != rich_round && !may_be_smaller) continue;
            plain_ = growths_.size();
            add(true);
            try_round(plain_, rich_round, on_progress);
        }
        return std::move(best_);
    }

  private:
    /// The state of a growth so far.
    struct Trial {
        std::uint64_t modules = 0; ///< that it has had in a round
        std::uint32_t start = 0;   ///< the next to be tried
        bool gave_up = false;      ///< at a start, for want of modules
        bool done = false;         ///< it has no system
    };

    void try_round(std::size_t from, int round, const std::function<void(double, int)>& on_progress) {
        for (std::size_t i = from; i < growths_.size(); ++i) {
            if (on_progress)
                on_progress(static_cast<double>(i) / static_cast<double>(growths_.size()), round);
            const std::uint64_t modules = modules_for(i, i >= plain_, round);
            if (trials_[i].modules < modules && !trials_[i].done && !too_large(growths_[i]))
                try_growth(i, modules);
        }
    }

    /// A system with nearly as many letters as it draws says nothing.
    bool too_large(const LsysGrowth& growth) const {
        return 3 * growth.size() > graph_.strokes || (best_ && growth.size() >= best_->growth.size());
    }

    void add(bool rich) {
        const std::vector<LsysGrowth> more = growths(graph_.strokes, rich, graph_.sized(), meter_);
        growths_.insert(growths_.end(), more.begin(), more.end());
        trials_.resize(growths_.size());
    }

    /// Tries a growth at as many starts as the modules suffice for; the next round goes on from there.
    void try_growth(std::size_t number, std::uint64_t most_modules) {
        const auto starts = static_cast<std::uint32_t>(graph_.starts.size());
        const std::uint64_t part = std::max(least_modules, most_modules / std::min(starts, 16u));
        Trial& trial = trials_[number];
        trial.modules = most_modules;
        for (std::uint64_t spent = 0; spent < most_modules && !trial.done; spent += unfolding_.modules()) {
            std::optional<FoundGrammar> found =
                unfolding_.find(growths_[number], graph_.starts[trial.start], part);
            trial.gave_up = trial.gave_up || unfolding_.gave_up();
            if (found) best_ = std::move(found), trial.done = true;
            if (trial.done) return;
            if (++trial.start < starts) continue;
            trial.done = !trial.gave_up;
            trial.start = 0;
            trial.gave_up = false;
            break;
        }
    }

    const StrokeGraph& graph_;
    WorkMeter& meter_;
    Unfolding unfolding_;
    std::vector<LsysGrowth> growths_; ///< plain ones, then rich ones
    std::size_t plain_ = SIZE_MAX;
    std::vector<Trial> trials_;
    std::optional<FoundGrammar> best_;
};

} // namespace

std::optional<FoundGrammar> find_grammar(const StrokeGraph& graph, WorkMeter& meter,
                                         const std::function<void(double, int)>& on_progress) {
    return GrammarSearch(graph, meter).run(on_progress);
}

} // namespace graftal
