#include "compiler/lsys/derive/rewriter.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "compiler/support/counter_random.h"
#include "compiler/support/number.h"

namespace graftal {

namespace {

/// Probabilities as printed in books sum to 1 within this.
constexpr double probability_slack = 0.0101;

/// Modules at times of which it is known what becomes of them; more are forgotten.
constexpr std::size_t most_timed = 1u << 22;

} // namespace

ChosenAlternative alternative_at(const std::vector<Alternative>& alternatives, double share) {
    ChosenAlternative chosen{&alternatives.front()};
    for (const Alternative& alternative : alternatives) {
        if (alternative.probability <= 0) continue;
        chosen = {&alternative, share / alternative.probability};
        share -= alternative.probability;
        if (share < 0) break;
    }
    chosen.within = std::clamp(chosen.within, 0.0, std::nextafter(1.0, 0.0));
    return chosen;
}

std::optional<ModuleString> LsysRewriter::axiom() {
    ModuleString string;
    if (!append(grammar_.axiom, nullptr, {}, cells(RuleKind::produce, 0), string)) return std::nullopt;
    return string;
}

bool LsysRewriter::prepare(unsigned steps) {
    if (grammar_.first_cells.empty() || grammar_.in_order || variables_.recorded() == steps) return !failed_;
    timed_.clear(); // entries of the last step were drawn
    timed_ids_.clear();
    failed_ = failed_ || !variables_.record(steps);
    return !failed_;
}

std::span<const double> LsysRewriter::known_cells(RuleKind kind, double step) const {
    if (!variables_.recorded()) return variables_.now();
    const auto whole = static_cast<unsigned>(step);
    return kind == RuleKind::interpret ? variables_.after(whole) : variables_.during(whole);
}

const std::vector<Alternative>* LsysRewriter::alternatives(RuleKind kind, ModuleId module,
                                                           const Moment& moment) {
    static const std::vector<Alternative> stays;
    const std::uint32_t found = find(kind, module, moment);
    if (found == error) return nullptr;
    return found == none ? &stays : &alternatives_[found];
}

bool LsysRewriter::is_rewritten(RuleKind kind, ModuleId module, const Moment& moment) {
    return grammar_.has_rules(kind, modules_.symbol(module)) && find(kind, module, moment) != none;
}

std::uint32_t LsysRewriter::find(RuleKind kind, ModuleId module, const Moment& moment) {
    TimeMask reads = grammar_.time(kind, modules_.symbol(module));
    if (birth_ != ModuleTable::no_birth && has_ages_) reads |= reads_step; // successors have their births
    if (reads != 0) return find_timed(kind, module, moment, reads);
    auto& known = known_[static_cast<std::size_t>(kind)];
    if (known.size() <= module) known.resize(modules_.size() + modules_.size() / 2, unknown);
    if (known[module] != unknown) return known[module];
    const std::uint32_t computed = compute(kind, module, moment);
    return known_[static_cast<std::size_t>(kind)][module] = computed;
}

std::uint32_t LsysRewriter::find_timed(RuleKind kind, ModuleId module, Moment moment, TimeMask reads) {
    if (timed_.size() >= most_timed) {
        timed_.clear();
        timed_ids_.clear();
    }
    if (!(reads & (reads_step | reads_variables))) moment.step = 0;
    if (!(reads & reads_age)) moment.age = 0;
    const std::uint64_t hash = mixed(
        mixed(mixed(static_cast<std::uint64_t>(kind), module), std::bit_cast<std::uint64_t>(moment.step)),
        std::bit_cast<std::uint64_t>(moment.age));
    const auto next = static_cast<std::uint32_t>(timed_.size());
    const std::uint32_t id = timed_ids_.find_or_add(hash, next, [&](std::uint32_t other) {
        const Timed& known = timed_[other];
        return known.kind == kind && known.module == module && known.moment.step == moment.step &&
               known.moment.age == moment.age;
    });
    if (id != next) return timed_[id].found;
    timed_.push_back({kind, module, moment, none});
    const std::uint32_t computed = compute(kind, module, moment);
    return timed_[id].found = computed;
}

std::uint32_t LsysRewriter::compute(RuleKind kind, ModuleId module, const Moment& moment) {
    const auto& rules = grammar_.candidates(kind, modules_.symbol(module));
    if (rules.empty()) return none;
    std::vector<Alternative> found;
    if (!collect(rules, module, moment, found)) {
        failed_ = true;
        return error;
    }
    if (found.empty()) return none;
    alternatives_.push_back(std::move(found));
    return static_cast<std::uint32_t>(alternatives_.size() - 1);
}

bool LsysRewriter::collect(const std::vector<std::uint32_t>& rules, ModuleId module, const Moment& moment,
                           std::vector<Alternative>& found) {
    const auto parameters = modules_.parameters(module);
    const std::vector<double> values(parameters.begin(), parameters.end());
    const auto first = try_rules(rules, values.size(), [&](const LsysRule& rule) {
        if (rule.sees_word()) return Fit::no;
        Alternative alternative;
        const Fit fit = apply(rule, values, moment, alternative);
        if (fit == Fit::yes) found.push_back(std::move(alternative));
        return fit;
    });
    if (!first) return false;
    return !*first || !(*first)->probability || normalise(found, **first);
}

std::optional<ModuleString> LsysRewriter::draw(const Alternative& alternative, ModuleId module,
                                               const Moment& moment, double within) {
    const auto parameters = modules_.parameters(module);
    const std::vector<double> values(parameters.begin(), parameters.end());
    const auto set = std::min(draw_sets - 1, static_cast<std::uint32_t>(within * draw_sets));
    ModuleString string;
    if (append_successor(*alternative.rule, values, moment, set, string)) return string;
    failed_ = true;
    return std::nullopt;
}

/// Calls come one after the other, and of each the sets: a number in every 64th part of [0, 1). The first
/// call's rise with the sets, so that those of any even choice of sets are spread evenly too; the others'
/// come in an order that chance gives.
const std::vector<double>& LsysRewriter::draws_of(const LsysRule& rule) {
    const auto id = static_cast<std::size_t>(&rule - grammar_.rules.data());
    draws_.resize(grammar_.rules.size());
    std::vector<double>& draws = draws_[id];
    if (!draws.empty()) return draws;
    for (std::uint32_t call = 0; call < rule.draws; ++call) {
        const CounterRandom random = CounterRandom(seed_).sequence(id).sequence(call);
        std::array<std::uint32_t, draw_sets> strata;
        std::iota(strata.begin(), strata.end(), 0u);
        for (std::uint32_t i = draw_sets - 1; call > 0 && i > 0; --i)
            std::swap(strata[i], strata[random(i) % (i + 1)]);
        for (std::uint32_t set = 0; set < draw_sets; ++set)
            draws.push_back((strata[set] + CounterRandom::unit(random(draw_sets + set))) / draw_sets);
    }
    return draws;
}

bool LsysRewriter::normalise(std::vector<Alternative>& found, const LsysRule& first) {
    double sum = 0;
    for (const Alternative& alternative : found)
        sum += alternative.probability;
    if (!sums_to_one(sum, first)) return false;
    for (Alternative& alternative : found)
        alternative.probability /= sum;
    return true;
}

bool LsysRewriter::sums_to_one(double sum, const LsysRule& first) {
    if (std::abs(sum - 1) <= probability_slack) return true;
    diagnostics_
        .error(
            first.source->probability->span,
            fmt::format("the probabilities of the productions that fit sum to {}, not to 1", shortest(sum)))
        .with_note(first.source->span, "this is the first of them");
    return false;
}

Fit LsysRewriter::apply(const LsysRule& rule, std::span<const double> values, const Moment& moment,
                        Alternative& result) {
    const auto slots = slots_of(rule, values, moment);
    if (!slots) return Fit::error;
    const std::optional<bool> fits = holds(rule, moment, *slots);
    if (!fits) return Fit::error;
    if (!*fits) return Fit::no;
    const std::optional<double> chance = probability_of(rule, moment, *slots);
    if (!chance) return Fit::error;
    result.rule = &rule;
    result.probability = *chance;
    result.successor.clear();
    if (rule.draws > 0) return Fit::yes;
    const bool applied = rule.is_plain() || apply_slots(rule, moment, 0, slots_);
    return applied && append_by(rule, moment, *slots, result.successor) ? Fit::yes : Fit::error;
}

LsysMachine::State LsysRewriter::state_of(const LsysRule& rule, const Moment& moment,
                                          std::span<double> slots) {
    return {.slots = slots,
            .names = rule.slots,
            .cells = cells(rule.kind, moment.step),
            .written_cells = chance_ ? variables_.now() : std::span<double>(),
            .chance = chance_};
}

bool LsysRewriter::try_slots(const LsysRule& rule, const Moment& moment, std::vector<double>& slots,
                             std::size_t first) {
    slots.push_back(moment.step);
    slots.push_back(moment.age);
    slots.resize(first + rule.slot_count(), 0.0);
    return rule.before.empty() ||
           machine_.run(rule.before, state_of(rule, moment, std::span(slots).subspan(first)));
}

bool LsysRewriter::apply_slots(const LsysRule& rule, const Moment& moment, std::uint32_t set,
                               std::vector<double>& slots, std::size_t first) {
    if (rule.draws > 0) {
        const std::vector<double>& draws = draws_of(rule);
        for (std::uint32_t call = 0; call < rule.draws; ++call)
            slots[first + rule.slots.size() + call] = draws[call * draw_sets + set];
    }
    return rule.after.empty() ||
           machine_.run(rule.after, state_of(rule, moment, std::span(slots).subspan(first)));
}

/// Valid until the next call.
std::optional<std::span<const double>>
LsysRewriter::slots_of(const LsysRule& rule, std::span<const double> values, const Moment& moment) {
    if (rule.is_plain()) return values;
    slots_.assign(values.begin(), values.end());
    if (!try_slots(rule, moment, slots_)) return std::nullopt;
    return slots_;
}

bool LsysRewriter::condition_holds(const LsysRule& rule, std::span<const double> values,
                                   const Moment& moment) {
    if (!rule.condition) return true;
    const auto slots = slots_of(rule, values, moment);
    return slots && holds(rule, moment, *slots).value_or(false);
}

std::optional<bool> LsysRewriter::holds(const LsysRule& rule, const Moment& moment,
                                        std::span<const double> slots) {
    if (!rule.condition) return true;
    const std::optional<double> truth = value(rule.condition->code, rule, moment, slots);
    if (!truth) return std::nullopt;
    return *truth != 0;
}

std::optional<double> LsysRewriter::probability(const LsysRule& rule, std::span<const double> values,
                                                const Moment& moment) {
    if (!rule.probability) return 1;
    const auto slots = slots_of(rule, values, moment);
    if (!slots) return std::nullopt;
    return probability_of(rule, moment, *slots);
}

std::optional<double> LsysRewriter::probability_of(const LsysRule& rule, const Moment& moment,
                                                   std::span<const double> slots) {
    if (!rule.probability) return 1;
    const std::optional<double> chance = value(*rule.probability, rule, moment, slots);
    if (!chance || *chance >= 0) return chance;
    diagnostics_.error(rule.source->probability->span,
                       fmt::format("a probability must not be negative, but is {}", shortest(*chance)));
    return std::nullopt;
}

bool LsysRewriter::append_successor(const LsysRule& rule, std::span<const double> values,
                                    const Moment& moment, std::uint32_t set, ModuleString& string) {
    if (rule.is_plain()) return append_by(rule, moment, values, string);
    const auto slots = slots_of(rule, values, moment);
    return slots && apply_slots(rule, moment, set, slots_) && append_by(rule, moment, slots_, string);
}

bool LsysRewriter::append_by(const LsysRule& rule, const Moment& moment, std::span<const double> slots,
                             ModuleString& string) {
    return append(rule.successor, &rule, slots, cells(rule.kind, moment.step), string);
}

std::optional<double> LsysRewriter::value(const ExpressionCode& code, const LsysRule& rule,
                                          const Moment& moment, std::span<const double> slots) {
    const std::span<const double> values = cells(rule.kind, moment.step);
    const std::optional<double> result = code.value(slots, values);
    if (!result) code.report(slots, grammar_.lets, rule.slots, diagnostics_, values);
    return result;
}

bool LsysRewriter::append(const std::vector<LsysTemplate>& templates, const LsysRule* rule,
                          std::span<const double> slots, std::span<const double> cells,
                          ModuleString& string) {
    const std::size_t known = modules_.size();
    const bool stamps = birth_ != ModuleTable::no_birth && (!rule || rule->kind != RuleKind::interpret);
    for (const LsysTemplate& module : templates) {
        arguments_.clear();
        for (const ExpressionCode& code : module.parameters) {
            const std::optional<double> argument = code.value(slots, cells);
            if (!argument) {
                code.report(slots, grammar_.lets,
                            rule ? std::span<const std::string_view>(rule->slots)
                                 : std::span<const std::string_view>(),
                            diagnostics_, cells);
                return false;
            }
            arguments_.push_back(*argument);
        }
        const bool stamped = stamps && grammar_.ages[module.symbol];
        string.push_back(
            modules_.intern(module.symbol, arguments_, stamped ? birth_ : ModuleTable::no_birth));
    }
    if (meter_) meter_->add(modules_.size() - known, StagePrice::new_module);
    if (modules_.size() <= max_distinct_modules) return true;
    diagnostics_
        .error(rule ? rule->source->span : grammar_.source->name.span,
               fmt::format("the derivation has more than {} different modules", max_distinct_modules))
        .with_hint(explosion_hint());
    return false;
}

const char* LsysRewriter::explosion_hint() const {
    if (grammar_.draws(RuleKind::produce) || grammar_.draws(RuleKind::decompose))
        return "random numbers in modules that keep growing make every module different: draw them in "
               "'interpret' instead";
    return "parameters that change without end make every part different";
}

} // namespace graftal
