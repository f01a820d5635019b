#include "compiler/lsys/compose/limit.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace graftal {

namespace {

constexpr double tolerance = 1e-9;
/// More classes than this are no limit that a graph could show.
constexpr std::size_t most_classes = 4096;

bool close(const Affine& a, const Affine& b) {
    return largest_entry(a.linear - b.linear) <= tolerance * largest_entry(a.linear) &&
           largest_entry(a.translation - b.translation) <= tolerance;
}

bool mentions(const Expression& expression, std::string_view name) {
    if (expression.kind == Expression::Kind::name) return expression.text == name;
    return std::ranges::any_of(expression.operands,
                               [&](const Expression& operand) { return mentions(operand, name); });
}

/// In the limit, what is smaller than the tolerance is a point.
bool lasts(const Instance& instance) {
    return largest_entry(instance.parent_from_child.linear) > tolerance;
}

/// A feature of some production by which derivations have no limit; null if there is none.
const char* obstacle_to_limit(const LsysGrammar& grammar) {
    if (grammar.has_queries()) return "with queries";
    for (const LsysRule& rule : grammar.rules) {
        if (rule.has_context()) return "with contexts";
        if (rule.sees_word()) return "that rewrite several modules at once";
        if (rule.probability) return "with probabilities";
        if (rule.draws > 0) return "with random numbers";
        if (rule.time & reads_variables) return "that read variables";
        if (rule.time != 0) return "that read 'step' or 'age'";
        if (rule.has_blocks()) return "with blocks";
    }
    return nullptr;
}

template<typename Visit> void for_each_lasting(const std::vector<Instance>& instances, const Visit& visit) {
    for (const Instance& instance : instances)
        if (lasts(instance)) visit(instance);
}

/// Passes over what does not last.
template<typename Same>
bool equal(const std::vector<Instance>& a, const std::vector<Instance>& b, const Same& same) {
    auto next = std::ranges::find_if(b, lasts);
    for (const Instance& instance : a) {
        if (!lasts(instance)) continue;
        if (next == b.end() || !same(instance, *next)) return false;
        next = std::find_if(next + 1, b.end(), lasts);
    }
    return next == b.end();
}

using ClassId = std::uint32_t;

class LevelFolder {
  public:
    LevelFolder(unsigned steps, const std::unordered_map<ObjectId, LsysComposer::Origin>& origins,
                const LsysRewriter& rewriter, Graph& graph, ObjectPool& pool, Diagnostics& diagnostics)
        : steps_(steps), origins_(origins), rewriter_(rewriter), graph_(graph), pool_(pool),
          diagnostics_(diagnostics) {}

    std::optional<std::vector<Instance>> fold(std::vector<Instance> instances) && {
        gather(instances);
        const unsigned depth = steps_ / 4;
        classes_.assign(levels_.size(), 0);
        for (unsigned round = 0; round < depth; ++round)
            refine();
        choose_representatives();
        if (!mark_reached(instances) || !check_parameters()) return std::nullopt;
        build();
        for (Instance& instance : instances)
            redirect(instance);
        return instances;
    }

  private:
    struct Level {
        ObjectId object = 0;
        ModuleId module = 0;
        SymbolId symbol = 0;
        unsigned steps = 0; ///< left
    };

    /// The lower half of the levels feels the end of the derivation: classes look a quarter of them down, and
    /// what vanishes in the limit is small, there, but not gone.
    bool is_deep(const Level& level) const { return level.steps <= steps_ / 2; }
    bool is_level(ObjectId object) const { return index_.contains(object); }

    /// All objects below that stand for modules of the derivation, those with most steps left first.
    void gather(const std::vector<Instance>& instances) {
        std::vector<ObjectId> stack;
        const auto push = [&](const Instance& instance) {
            const auto origin = origins_.find(instance.master);
            if (origin == origins_.end() || !index_.try_emplace(instance.master, 0).second) return;
            const ModuleId module = origin->second.module;
            levels_.push_back(
                {instance.master, module, rewriter_.modules().symbol(module), origin->second.steps});
            stack.push_back(instance.master);
        };
        std::ranges::for_each(instances, push);
        while (!stack.empty()) {
            const ObjectId object = stack.back();
            stack.pop_back();
            for_each_lasting(graph_.objects[object].instances, push);
        }
        std::ranges::stable_sort(levels_, [](const Level& a, const Level& b) { return a.steps > b.steps; });
        for (std::size_t i = 0; i < levels_.size(); ++i)
            index_[levels_[i].object] = i;
    }

    /// Splits classes whose members' lists differ, given the classes so far.
    void refine() {
        std::map<std::tuple<ClassId, SymbolId, std::size_t>, std::vector<std::size_t>> representatives;
        std::vector<ClassId> refined(levels_.size());
        ClassId next = 0;
        for (std::size_t i = 0; i < levels_.size(); ++i) {
            const auto count = static_cast<std::size_t>(
                std::ranges::count_if(graph_.objects[levels_[i].object].instances, lasts));
            auto& known = representatives[{classes_[i], levels_[i].symbol, count}];
            const auto same = std::ranges::find_if(known, [&](std::size_t other) { return agree(i, other); });
            if (same == known.end()) {
                known.push_back(i);
                refined[i] = next++;
            } else {
                refined[i] = refined[*same];
            }
        }
        classes_ = std::move(refined);
    }

    bool agree(std::size_t a, std::size_t b) const {
        const Object& x = graph_.objects[levels_[a].object];
        const Object& y = graph_.objects[levels_[b].object];
        if (x.terminal.has_value() != y.terminal.has_value()) return false;
        if (x.terminal && !agree(*x.terminal, *y.terminal)) return false;
        const auto same = [&](const Instance& p, const Instance& q) { return agree(p, q); };
        return equal(x.instances, y.instances, same);
    }

    bool agree(const Instance& a, const Instance& b) const {
        if (a.material != b.material || !close(a.parent_from_child, b.parent_from_child)) return false;
        const auto x = index_.find(a.master), y = index_.find(b.master);
        if (x == index_.end() || y == index_.end()) return a.master == b.master;
        return classes_[x->second] == classes_[y->second];
    }

    /// The member with most steps left stands for its class: levels_ are sorted.
    void choose_representatives() {
        for (std::size_t i = 0; i < levels_.size(); ++i)
            representative_.try_emplace(classes_[i], i);
    }

    const Level& representative(ObjectId object) const {
        return levels_[representative_.at(classes_[index_.at(object)])];
    }

    /// False if a class is reached that only objects near the end of the derivation belong to.
    bool mark_reached(const std::vector<Instance>& instances) {
        std::vector<ObjectId> stack;
        const auto push = [&](const Instance& instance) {
            if (!is_level(instance.master)) return;
            const ObjectId object = representative(instance.master).object;
            if (reached_.try_emplace(object, 0).second) stack.push_back(object);
        };
        std::ranges::for_each(instances, push);
        while (!stack.empty()) {
            const ObjectId object = stack.back();
            stack.pop_back();
            if (is_deep(levels_[index_.at(object)]) || reached_.size() > most_classes) return false;
            for_each_lasting(graph_.objects[object].instances, push);
        }
        return true;
    }

    /// Parameters that differ within a class must not decide which productions fit.
    bool check_parameters() const {
        for (std::size_t i = 0; i < levels_.size() && !is_deep(levels_[i]); ++i) {
            const auto here = rewriter_.modules().parameters(levels_[i].module);
            const auto there =
                rewriter_.modules().parameters(levels_[representative_.at(classes_[i])].module);
            for (std::size_t k = 0; k < std::min(here.size(), there.size()); ++k)
                if (here[k] != there[k] && !check_parameter(levels_[i].symbol, k)) return false;
        }
        return true;
    }

    bool check_parameter(SymbolId symbol, std::size_t position) const {
        for (const std::uint32_t id : rewriter_.grammar().candidates(RuleKind::produce, symbol)) {
            const LsysRule& rule = rewriter_.grammar().rules[id];
            if (rule.predecessor.arity <= position) continue;
            const std::string_view name = rule.variables[position];
            const auto& condition = rule.source->condition;
            if (!condition || !mentions(*condition, name)) continue;
            diagnostics_
                .error(condition->span,
                       fmt::format("'{}' changes from step to step, so this condition decides when to stop",
                                   name))
                .with_hint("such a derivation ends, so give a number of steps: 'steps N'");
            return false;
        }
        return true;
    }

    /// A copy of each representative, over copies.
    void build() {
        std::vector<ObjectId> originals;
        for (const auto& [object, copy] : reached_)
            originals.push_back(object);
        std::ranges::sort(originals);
        for (const ObjectId object : originals) {
            Object copy = graph_.objects[object];
            std::erase_if(copy.instances, [](const Instance& instance) { return !lasts(instance); });
            const SymbolId symbol = levels_[index_.at(object)].symbol;
            copy.name = pool_.unique_name(object_name(rewriter_.grammar().symbols[symbol]));
            reached_[object] = graph_.add(std::move(copy));
        }
        for (const ObjectId object : originals)
            for (Instance& instance : graph_.objects[reached_[object]].instances)
                redirect(instance);
    }

    void redirect(Instance& instance) const {
        if (is_level(instance.master)) instance.master = reached_.at(representative(instance.master).object);
    }

    unsigned steps_;
    const std::unordered_map<ObjectId, LsysComposer::Origin>& origins_;
    const LsysRewriter& rewriter_;
    Graph& graph_;
    ObjectPool& pool_;
    Diagnostics& diagnostics_;
    std::vector<Level> levels_;
    std::unordered_map<ObjectId, std::size_t> index_; ///< into levels_
    std::vector<ClassId> classes_;                    ///< of levels_
    std::unordered_map<ClassId, std::size_t> representative_;
    std::unordered_map<ObjectId, ObjectId> reached_; ///< representatives, with their copies
};

} // namespace

bool may_have_limit(const LsysGrammar& grammar, Diagnostics& diagnostics) {
    Diagnostic* error = nullptr;
    if (const char* const obstacle = obstacle_to_limit(grammar))
        error = &diagnostics.error(grammar.source->steps->span,
                                   fmt::format("productions {} have no limit", obstacle));
    else if (grammar.skin > 0)
        error = &diagnostics.error(grammar.source->skin->span,
                                   "the limbs of a limit have no end, and so no skin");
    if (error) error->with_hint("give 'steps N'");
    return !error;
}

std::optional<std::vector<Instance>>
fold_levels(const std::vector<Instance>& instances, unsigned steps,
            const std::unordered_map<ObjectId, LsysComposer::Origin>& origins, const LsysRewriter& rewriter,
            Graph& graph, ObjectPool& pool, Diagnostics& diagnostics) {
    return LevelFolder(steps, origins, rewriter, graph, pool, diagnostics).fold(instances);
}

Affine unit_limit(const TurtlePart& figure, double half, double most, double step) {
    constexpr double same = 1e-6;
    // The reach of a figure that converges changes by one factor in as many steps (A. Aitken's limit).
    const double gain = figure.reach - most, factor = gain / (most - half);
    const double limit = figure.reach + gain * factor / (1 - factor);
    const bool settles = std::abs(factor) < 1 - same && limit > same * figure.reach;
    if (std::abs(gain) <= same * figure.reach || settles) return {};
    const Vec3 chord = figure.start_from_exit.translation;
    const double length = glm::length(chord);
    if (length > same * figure.reach)
        return {glm::transpose(chord_frame(chord)) * (step / length), Vec3(0.0)};
    return {Mat3(step / figure.reach), Vec3(0.0)};
}

} // namespace graftal
