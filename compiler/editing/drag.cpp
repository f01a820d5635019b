#include "compiler/editing/drag.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "compiler/editing/chance_spread.h"
#include "compiler/editing/rounding.h"
#include "compiler/graph/run.h"
#include "compiler/languages/lower.h"
#include "compiler/lsys/parse/turtle_command.h"
#include "compiler/support/number.h"

namespace graftal {

namespace {

/// Numbers that are tried at most, those of the last rules first.
constexpr std::size_t most_tried = 24;
/// The change of a number by which its effect is found, as a share of it.
constexpr double probe_share = 1e-4, smallest_number = 0.01;
/// The share of the way and of the place by which the point moves then, at most.
constexpr double most_probed = 0.01;
/// The price of a number of a rule further up, against the share of the way that is left.
constexpr double price_of_a_rule = 0.03;
/// A number that has to change by more than itself costs so much for each time.
constexpr double price_of_large_changes = 0.05;
/// A number is of use where it brings the point by this share nearer.
constexpr double least_gain = 0.05;
constexpr int most_drag_steps = 6;

/// A number of the text that may change.
struct Candidate {
    Span span;
    double value = 0;
    std::size_t rules_up = 0;  ///< between its rule, or the first that reads it, and the part
    bool only_spreads = false; ///< chance, wherever it is read (chance_spread.h)
    Vec3 slope{0.0};           ///< of the point, by the number
};

/// The place that a part has in a graph.
struct PartPlace {
    Affine world_from_part;
    std::vector<Span> rules; ///< on the way, the last one first, each once
    const Object* object = nullptr;
};

std::optional<PartPlace> part_place(const Graph& graph, const std::vector<std::uint32_t>& instances) {
    PartPlace place;
    place.object = &graph.objects[graph.root];
    for (const std::uint32_t number : instances) {
        if (number >= place.object->instances.size()) return std::nullopt;
        const Instance& instance = place.object->instances[number];
        place.world_from_part = place.world_from_part * instance.parent_from_child;
        place.rules.push_back(instance.span);
        place.object = &graph.objects[instance.master];
    }
    std::ranges::reverse(place.rules);
    std::vector<Span> once;
    for (const Span& span : place.rules)
        if (span.known() && span.file == FileId{0} && std::ranges::count(once, span) == 0)
            once.push_back(span);
    place.rules = std::move(once);
    return place;
}

/// The string of a block, and the place that instances of its modules have.
struct Rule {
    const LsysBlock* block = nullptr;
    const LsysString* string = nullptr;
    Span span;
};

std::vector<Rule> rules_of(const LsysFile& tree) {
    std::vector<Rule> rules;
    for (const LsysBlock& block : tree.blocks) {
        if (block.axiom) rules.push_back({&block, &*block.axiom, block.axiom->span});
        for (const auto* productions : {&block.productions, &block.interpret, &block.decompose})
            for (const LsysProduction& production : *productions)
                rules.push_back({&block, &production.successor, production.span});
    }
    return rules;
}

/// Other settings, such as the width, bring no part to another place.
bool is_setting_of_place(const ModelParameter& parameter) {
    return parameter.kind == ModelParameter::Kind::setting &&
           (parameter.name == "angle" || parameter.name == "step");
}

/// A turn or a move without an argument reads the setting of the block.
bool reads_setting(const LsysString& string) {
    return std::ranges::any_of(string.modules, [](const LsysModule& module) {
        return module.parameters.empty() && turtle_command(module.symbol) != TurtleCommand::none;
    });
}

class Dragger {
  public:
    Dragger(const Document& document, const DraggedPart& part, const EditContext& context)
        : document_(document), part_(part), context_(context) {}

    DragChange run() {
        if (!document_.lsys()) return {{}, "Only parts of L-systems are dragged by their rules."};
        SourceMap sources;
        Diagnostics diagnostics;
        const LoweredText lowered = lower(std::string(document_.text()), sources, diagnostics);
        if (!lowered.graph) return {{}, "The text has errors."};
        const std::optional<PartPlace> place = part_place(*lowered.graph, part_.instances);
        if (!place || is_singular(place->world_from_part))
            return {{}, "The picture shows another text: click on the part again."};
        const Vec3 inside = inverse(place->world_from_part)(part_.from);
        if (place->object->packed)
            item_ = nearest_item(*place->object->packed.run, inside);
        else
            local_ = on_axis(place->object->primitive, inside);
        start_ = *point_in(*place);
        // The point need not lie on a packed part: it keeps its way from there.
        wanted_ = part_.to - part_.from;
        if (!(glm::length(wanted_) > 0)) return {{}, "The point is there already."};
        std::vector<Candidate> candidates = candidates_of(*place, lowered.notes.parameters);
        if (part_.number)
            std::erase_if(candidates, [&](const Candidate& one) { return one.span.begin != *part_.number; });
        if (candidates.size() > most_tried) candidates.resize(most_tried);
        const auto spreading = std::ranges::find(candidates, true, &Candidate::only_spreads);
        for (const std::span<Candidate> some :
             {std::span(candidates.begin(), spreading), std::span(spreading, candidates.end())})
            if (auto change = best_change(some)) return *std::move(change);
        return {{},
                part_.number ? "This number brings the part no nearer: let go, and drag it again."
                             : "No number of the rules that made this part moves it that way."};
    }

  private:
    LoweredText lower(std::string text, SourceMap& sources, Diagnostics& diagnostics) const {
        return lower_text(document_.name(), std::move(text), context_.lower, sources, diagnostics,
                          context_.help);
    }

    /// How thick a segment is depends on the whole model: its axis is what turns and moves.
    static Vec3 on_axis(const std::optional<Primitive>& primitive, Vec3 point) {
        const bool round = primitive == PrimitiveKind::cylinder || primitive == PrimitiveKind::cone;
        return round ? Vec3(0, point.y, 0) : point;
    }

    static std::size_t nearest_item(const Run& run, Vec3 point) {
        std::size_t best = 0;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < run.size(); ++i) {
            const double distance = glm::distance(middle(run[i]), point);
            if (!(distance < least)) continue;
            least = distance;
            best = i;
        }
        return best;
    }

    static Vec3 middle(const RunItem& item) { return item.base + 0.5 * item.axis; }

    std::optional<Vec3> point_in(const PartPlace& place) const {
        if (!item_) return place.world_from_part(local_);
        const auto& run = place.object->packed.run;
        if (!run || *item_ >= run->size()) return std::nullopt;
        return place.world_from_part(middle((*run)[*item_]));
    }

    std::string text_with(const Candidate& candidate, std::string_view number) const {
        return applied(document_.text(), {{candidate.span.begin, candidate.span.end, std::string(number)}});
    }

    /// How far the point has come with another number; nothing where the part is not there then.
    std::optional<Vec3> moved(const Candidate& candidate, double value) const {
        SourceMap sources;
        Diagnostics diagnostics;
        const LoweredText lowered =
            lower(text_with(candidate, written(candidate, value, all_digits)), sources, diagnostics);
        if (!lowered.graph) return std::nullopt;
        const std::optional<PartPlace> place = part_place(*lowered.graph, part_.instances);
        const std::optional<Vec3> point = place ? point_in(*place) : std::nullopt;
        return point ? std::optional(*point - start_) : std::nullopt;
    }

    /// A negative number stands in parentheses where an operator may be before it.
    std::string written(const Candidate& candidate, double value, int digits) const {
        std::string number;
        append_number(number, value, digits);
        const std::string_view before = document_.text().substr(0, candidate.span.begin);
        const std::size_t last = before.find_last_not_of(' ');
        const bool alone = last == std::string_view::npos || before[last] == '(' || before[last] == ',' ||
                           before[last] == '=' || std::isalpha(static_cast<unsigned char>(before[last]));
        return value < 0 && !alone ? "(" + number + ")" : number;
    }

    /// Numbers that only spread chance come last: they are for parts that no other moves.
    std::vector<Candidate> candidates_of(const PartPlace& place,
                                         const std::vector<ModelParameter>& parameters) const {
        std::vector<Candidate> found;
        std::map<std::uint32_t, std::size_t> met; ///< by the first byte
        const auto add = [&](const Candidate& one) {
            const auto [known, is_new] = met.try_emplace(one.span.begin, found.size());
            if (is_new)
                found.push_back(one);
            else if (!one.only_spreads)
                found[known->second].only_spreads = false;
        };
        std::multimap<std::string_view, const ModelParameter*> lets; ///< of all blocks
        for (const ModelParameter& parameter : parameters)
            if (is_literal(parameter) && parameter.kind != ModelParameter::Kind::setting)
                lets.emplace(parameter.name, &parameter);
        const std::vector<Rule> rules = rules_of(*document_.lsys());
        const ChanceSpread spread(*document_.lsys());
        for (std::size_t up = 0; up < place.rules.size(); ++up) {
            const auto rule = std::ranges::find(rules, place.rules[up], &Rule::span);
            if (rule == rules.end()) continue;
            const auto add_leaf = [&](const Expression& leaf, bool only_spreads) {
                if (leaf.kind == Expression::Kind::number) {
                    if (leaf.span.known() && leaf.span.file == FileId{0})
                        add({leaf.span, leaf.number, up, only_spreads});
                    return;
                }
                const auto [first, last] = lets.equal_range(leaf.text);
                for (auto let = first; let != last; ++let)
                    add({let->second->span, let->second->value, up, only_spreads});
            };
            for (const LsysModule& module : rule->string->modules)
                spread.visit(*rule->block, module, add_leaf);
            for (const ModelParameter& parameter : parameters)
                if (is_literal(parameter) && is_setting_of_place(parameter) && reads_setting(*rule->string))
                    add({parameter.span, parameter.value, up, false});
        }
        std::ranges::stable_partition(found, std::logical_not(), &Candidate::only_spreads);
        return found;
    }

    static bool is_literal(const ModelParameter& parameter) {
        return parameter.literal && parameter.span.file == FileId{0};
    }

    void find_slope(Candidate& candidate) const {
        const double step = probe_share * std::max(std::abs(candidate.value), smallest_number);
        const std::optional<Vec3> way = moved(candidate, candidate.value + step);
        // A number that decides which rule is taken makes the part jump.
        if (way && glm::length(*way) < most_probed * (glm::length(wanted_) + glm::length(start_)))
            candidate.slope = *way / step;
    }

    static double along(Vec3 slope, Vec3 way) { return glm::dot(slope, way) / glm::dot(slope, slope); }

    /// Nothing where none of them is of use.
    std::optional<DragChange> best_change(std::span<Candidate> candidates) const {
        for (Candidate& candidate : candidates)
            find_slope(candidate);
        std::ranges::stable_sort(candidates, {}, [&](const Candidate& one) { return cost(one); });
        for (const Candidate& candidate : candidates) {
            if (!(cost(candidate) < 1)) break;
            if (auto change = change_of(candidate)) return change;
        }
        return std::nullopt;
    }

    /// The share of the way that the number leaves, and the price of the number; 1 or more: of no use.
    double cost(const Candidate& candidate) const {
        if (!(glm::length(candidate.slope) > 0)) return 1;
        const double change = along(candidate.slope, wanted_);
        const double left = glm::length(wanted_ - change * candidate.slope) / glm::length(wanted_);
        if (!(left < 1 - least_gain)) return 1;
        const double times = std::abs(change) / std::max(std::abs(candidate.value), smallest_number);
        return std::min(left + price_of_a_rule * static_cast<double>(candidate.rules_up) +
                            price_of_large_changes * std::log2(1 + times),
                        1 - least_gain);
    }

    /// Goes with the number until the point comes no nearer.
    std::optional<DragChange> change_of(const Candidate& candidate) const {
        double value = candidate.value;
        Vec3 way(0.0), slope = candidate.slope;
        for (int step = 0; step < most_drag_steps; ++step) {
            const double by = along(slope, wanted_ - way);
            if (!(std::abs(by) * glm::length(slope) > least_gain * least_gain * glm::length(wanted_))) break;
            const std::optional<Vec3> next = moved(candidate, value + by);
            if (!next || !(glm::distance(*next, wanted_) < glm::distance(way, wanted_))) break;
            slope = (*next - way) / by;
            value += by;
            way = *next;
            if (!(glm::length(slope) > 0)) break;
        }
        if (!(glm::distance(way, wanted_) < (1 - least_gain) * glm::length(wanted_))) return std::nullopt;
        const double read = rounded(value, decimals(slope));
        DragChange change;
        change.edits = {{candidate.span.begin, candidate.span.end, written(candidate, read, sure_digits)}};
        change.number = candidate.span.begin;
        change.point = part_.from + way + (read - value) * slope;
        return change;
    }

    /// Decimals that the hand can tell.
    int decimals(Vec3 slope) const {
        constexpr double noticed = 0.02; // of the way
        const double grain = part_.grain > 0 ? part_.grain : noticed * glm::length(wanted_);
        return decimals_for([&](double off) { return off * glm::length(slope) <= grain; });
    }

    static constexpr int all_digits = 17, sure_digits = 15;

    const Document& document_;
    const DraggedPart& part_;
    const EditContext& context_;
    Vec3 local_{0.0};                 ///< the point in the part's frame
    std::optional<std::size_t> item_; ///< of a packed part, in place of that
    Vec3 start_{0.0}, wanted_{0.0};   ///< where the point is, and its way
};

} // namespace

DragChange drag_part(const Document& document, const DraggedPart& part, const EditContext& context) {
    return Dragger(document, part, context).run();
}

} // namespace graftal
