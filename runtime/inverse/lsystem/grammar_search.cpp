#include "runtime/inverse/lsystem/grammar_search.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "runtime/inverse/lsystem/equal_parts.h"

namespace graftal {

namespace {

constexpr int most_rounds = 14;
constexpr int rich_round = 3; ///< the first with three letters that have rules of their own
constexpr int tree_round = 4; ///< the first after equal parts of a tree were looked for
/// Modules of each kind in the first round: more where there are fewer growths. Each round has four times as
/// many as the round before.
constexpr std::array<std::uint64_t, growth_kinds> first_modules = {200'000, 150'000, 75'000,
                                                                   75'000,  100'000, 50'000};
constexpr std::uint64_t least_modules = 300;
constexpr std::uint64_t most_parts = 30'000'000; ///< that are compared for each kind, in a tree

class GrammarSearch {
  public:
    GrammarSearch(const StrokeGraph& graph, WorkMeter& meter)
        : graph_(graph), meter_(meter), unfolding_(graph, meter) {
        for (const std::uint32_t place : graph.starts)
            for (const StrokeWay& way : graph.ways(place))
                if (starts_.empty() || starts_.back() != Start{place, way.direction})
                    starts_.push_back({place, way.direction});
    }

    std::optional<FoundGrammar> run(const std::function<void(double, int)>& on_progress) {
        for (int round = 0; round < most_rounds && !best_; ++round) {
            if (round == tree_round) try_tree();
            if (best_) break;
            for (std::size_t kind = 0; kind < growth_kinds; ++kind) {
                if (on_progress) on_progress(static_cast<double>(kind) / growth_kinds, round);
                if (round >= rich_round || !is_rich(static_cast<GrowthKind>(kind))) try_kind(kind, round);
            }
        }
        return std::move(best_);
    }

  private:
    struct Start {
        std::uint32_t place = 0;
        std::int32_t direction = 0; ///< of the first stroke
        bool operator==(const Start&) const = default;
    };

    /// A growth, and the state of its search.
    struct Trial {
        LsysGrowth growth;
        std::size_t untried = 0;          ///< the first start that was not tried
        std::vector<std::size_t> waiting; ///< starts that were tried and need more modules
    };

    static bool is_rich(GrowthKind kind) {
        return kind == GrowthKind::three_edges || kind == GrowthKind::three_nodes;
    }

    /// The growths of a kind that were not given up.
    std::vector<Trial>& listed(std::size_t kind) {
        if (!std::exchange(listed_[kind], true))
            for (const LsysGrowth& growth :
                 growths(graph_.strokes, static_cast<GrowthKind>(kind), graph_.sized(), meter_))
                trials_[kind].push_back({growth, 0, {}});
        return trials_[kind];
    }

    /// The smallest growths of a kind have the most modules.
    void try_kind(std::size_t kind, int round) {
        std::vector<Trial>& trials = listed(kind);
        double sum = 0;
        std::erase_if(trials,
                      [&](const Trial& trial) { return starts_left(trial) == 0 || too_large(trial.growth); });
        for (std::size_t i = 0; i < trials.size(); ++i)
            sum += weight(i);
        // The first order opens brackets last, so that simple systems come out without needless ones.
        const unsigned order = round < rich_round ? 0 : static_cast<unsigned>(round);
        const double modules = static_cast<double>(first_modules[kind] << 2 * round) / sum;
        for (std::size_t i = 0; i < trials.size(); ++i) {
            const auto most_modules = static_cast<std::uint64_t>(modules * weight(i));
            if (most_modules < least_modules) break;
            if (!too_large(trials[i].growth)) try_growth(trials[i], most_modules, order);
        }
    }

    /// Tries growths with numbers by letter in a tree, by its equal parts. The first rounds, which find
    /// simple systems, come before.
    void try_tree() {
        EqualParts parts(graph_, meter_);
        if (!parts.is_tree()) return;
        for (const bool rich : {false, true})
            for (std::size_t number = 0; number < growth_kinds; ++number) {
                const auto kind = static_cast<GrowthKind>(number);
                if (is_rich(kind) != rich || best_) continue;
                std::uint64_t left = most_parts;
                for (const Trial& trial : listed(number))
                    if (left > 0) try_parts(parts, trial.growth, left);
                if (best_ || (kind != GrowthKind::two_edges && !rich)) continue;
                for (const LsysGrowth& growth : growths(graph_.strokes, kind, graph_.sized(), meter_, true))
                    if (left > 0) try_parts(parts, growth, left);
            }
    }

    /// Takes from the comparisons that are left; all after a system was found.
    void try_parts(EqualParts& parts, const LsysGrowth& growth, std::uint64_t& left) {
        if (!growth.by_letter || too_large(growth)) return;
        const std::uint64_t most = least_modules + 20 * graph_.strokes;
        const auto draws_all = [&](const BareRules& rules) {
            return std::ranges::any_of(starts_, [&](const Start& start) {
                best_ = unfolding_.find(growth, start.place, start.direction, most, 0, &rules);
                return best_.has_value();
            });
        };
        left = parts.find(growth, draws_all) ? 0 : left - std::min<std::uint64_t>(left, parts.spent());
    }

    static double weight(std::size_t place) { return 1 / static_cast<double>(place + 10); }

    /// A system with nearly as many letters as it draws says nothing.
    bool too_large(const LsysGrowth& growth) const {
        return 3 * growth.size() > graph_.strokes || (best_ && growth.size() >= best_->growth.size());
    }

    std::size_t starts_left(const Trial& trial) const {
        return starts_.size() - trial.untried + trial.waiting.size();
    }

    /// Tries a growth at all its starts, or at the first of them if the modules do not suffice. Then the
    /// others come first in the next round.
    void try_growth(Trial& trial, std::uint64_t most_modules, unsigned order) {
        const std::uint64_t part = std::max(least_modules, most_modules / starts_left(trial));
        std::uint64_t spent = 0;
        std::size_t again = 0;
        const std::size_t waiting = trial.waiting.size();
        while (spent < most_modules && (trial.untried < starts_.size() || again < waiting)) {
            const std::size_t number =
                trial.untried < starts_.size() ? trial.untried++ : trial.waiting[again++];
            const auto [place, direction] = starts_[number];
            std::optional<FoundGrammar> found = unfolding_.find(trial.growth, place, direction, part, order);
            spent += unfolding_.modules();
            if (found) {
                best_ = std::move(found);
                return;
            }
            if (unfolding_.gave_up()) trial.waiting.push_back(number);
        }
        trial.waiting.erase(trial.waiting.begin(),
                            trial.waiting.begin() + static_cast<std::ptrdiff_t>(again));
    }

    const StrokeGraph& graph_;
    WorkMeter& meter_;
    Unfolding unfolding_;
    std::vector<Start> starts_;
    std::array<std::vector<Trial>, growth_kinds> trials_;
    std::array<bool, growth_kinds> listed_{};
    std::optional<FoundGrammar> best_;
};

} // namespace

std::optional<FoundGrammar> find_grammar(const StrokeGraph& graph, WorkMeter& meter,
                                         const std::function<void(double, int)>& on_progress) {
    return GrammarSearch(graph, meter).run(on_progress);
}

} // namespace graftal
