#include "runtime/inverse/lsystem/grammar_search.h"

#include <algorithm>
#include <cstdint>

namespace graftal {

namespace {

constexpr int most_rounds = 9;
constexpr int rich_round = 2; ///< the first with rich systems
constexpr std::uint64_t first_modules = 250'000, rich_modules = 1'200, least_modules = 300;
constexpr std::size_t least_rich_size = 8;
constexpr std::size_t first_starts = 2; ///< in the first round; each has 64 times as many

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
    static constexpr std::uint64_t never = UINT64_MAX;

    void try_round(std::size_t from, int round, const std::function<void(double, int)>& on_progress) {
        for (std::size_t i = from; i < growths_.size(); ++i) {
            if (on_progress) on_progress(static_cast<double>(i) / static_cast<double>(growths_.size()), round);
            const std::uint64_t modules = modules_for(i, i >= plain_, round);
            if (open_[i] < modules && !too_large(growths_[i])) try_growth(i, modules, round);
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

    void try_growth(std::size_t number, std::uint64_t most_modules, int round) {
        const std::size_t starts = std::min(graph_.starts.size(), first_starts << std::min(6 * round, 40));
        const std::uint64_t part = std::max(least_modules, most_modules / std::min<std::size_t>(starts, 16));
        open_[number] = starts == graph_.starts.size() ? never : most_modules;
        for (std::size_t i = 0; i < starts; ++i) {
            std::optional<FoundGrammar> found = unfolding_.find(growths_[number], graph_.starts[i], part);
            if (unfolding_.gave_up()) open_[number] = most_modules;
            if (!found) continue;
            best_ = std::move(found);
            return;
        }
    }

    const StrokeGraph& graph_;
    WorkMeter& meter_;
    Unfolding unfolding_;
    std::vector<Growth> growths_; ///< plain ones, then rich ones
    std::size_t plain_ = SIZE_MAX;
    std::vector<std::uint64_t> open_; ///< modules that each has had; never: it has no system
    std::optional<FoundGrammar> best_;
};

} // namespace

std::optional<FoundGrammar> find_grammar(const StrokeGraph& graph, WorkMeter& meter,
                                         const std::function<void(double, int)>& on_progress) {
    return GrammarSearch(graph, meter).run(on_progress);
}

} // namespace graftal
