#include "runtime/inverse/lsystem/grammar_search.h"

#include <algorithm>

namespace graftal {

namespace {

constexpr int most_rounds = 9;
constexpr int rich_round = 2; ///< the first with rich systems
constexpr std::uint64_t first_modules = 250'000, least_modules = 300;

/// Modules for a growth in a round, at all starts together: more for those that come early.
std::uint64_t modules_for(std::size_t place, int round) {
    return std::max(least_modules, (first_modules << (3 * round)) / (place + 20));
}

class GrammarSearch {
  public:
    GrammarSearch(const StrokeGraph& graph, WorkMeter& meter)
        : graph_(graph), meter_(meter), unfolding_(graph, meter) {}

    std::optional<FoundGrammar> run(const std::function<void(double, int)>& on_progress) {
        add(false);
        for (int round = 0; round < most_rounds && !best_; ++round) {
            try_round(0, round, on_progress);
            if (round != rich_round && (!best_ || round > rich_round)) continue;
            const std::size_t before = growths_.size();
            add(true); // after a find, to see that no smaller one is among them
            try_round(before, round, on_progress);
        }
        return std::move(best_);
    }

  private:
    static constexpr std::uint64_t never = UINT64_MAX;

    void try_round(std::size_t from, int round, const std::function<void(double, int)>& on_progress) {
        for (std::size_t i = from; i < growths_.size(); ++i) {
            if (on_progress) on_progress(static_cast<double>(i) / static_cast<double>(growths_.size()), round);
            if (open_[i] < modules_for(i, round) && !too_large(growths_[i]))
                try_growth(i, modules_for(i, round));
        }
    }

    /// A system with nearly as many letters as it draws says nothing.
    bool too_large(const Growth& growth) const {
        return 3 * growth.size() > graph_.strokes || (best_ && growth.size() >= best_->growth.size());
    }

    void add(bool rich) {
        const std::vector<Growth> more = growths(graph_.strokes, rich, graph_.sized(), meter_);
        growths_.insert(growths_.end(), more.begin(), more.end());
        open_.resize(growths_.size(), 0);
    }

    void try_growth(std::size_t number, std::uint64_t most_modules) {
        const std::uint64_t part =
            std::max(least_modules, most_modules / std::min<std::uint64_t>(graph_.starts.size(), 16));
        open_[number] = never;
        for (const std::uint32_t start : graph_.starts) {
            std::optional<FoundGrammar> found = unfolding_.find(growths_[number], start, part);
            if (unfolding_.gave_up()) open_[number] = most_modules;
            if (!found) continue;
            best_ = std::move(found);
            return;
        }
    }

    const StrokeGraph& graph_;
    WorkMeter& meter_;
    Unfolding unfolding_;
    std::vector<Growth> growths_;
    std::vector<std::uint64_t> open_; ///< modules that each has had; never: it has no system
    std::optional<FoundGrammar> best_;
};

} // namespace

std::optional<FoundGrammar> find_grammar(const StrokeGraph& graph, WorkMeter& meter,
                                         const std::function<void(double, int)>& on_progress) {
    return GrammarSearch(graph, meter).run(on_progress);
}

} // namespace graftal
