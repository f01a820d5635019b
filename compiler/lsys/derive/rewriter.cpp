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
    if (!grammar_.has_rules(kind, modules_.symbol(module))) return none;
    const std::vector<double> values = parameters(module);
    std::vector<Alternative> found;
    if (!compete(kind, modules_.symbol(module), values.size(), found, [&](Alternative& alternative) {
            return alternative.rule->sees_word() ? Fit::no : apply(alternative, values, moment);
        })) {
        failed_ = true;
        return error;
    }
    if (found.empty()) return none;
    alternatives_.push_back(std::move(found));
    return static_cast<std::uint32_t>(alternatives_.size() - 1);
}

/// A copy: interning modules moves those of the table.
std::vector<double> LsysRewriter::parameters(ModuleId module) const {
    const auto parameters = modules_.parameters(module);
    return {parameters.begin(), parameters.end()};
}

const ModuleString* LsysRewriter::successor(const Alternative& alternative, ModuleId module,
                                            const Moment& moment, RuleDraw draw) {
    if (alternative.rule->draws == 0) return &alternative.successor;
    drawn_.clear();
    if (append_successor(*alternative.rule, parameters(module), moment, draw, drawn_)) return &drawn_;
    failed_ = true;
    return nullptr;
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

/// Whether the probabilities of competing rules sum to 1 as closely as books print them; if not, reports it.
bool LsysRewriter::sums_to_one(double sum, const LsysRule& first) {
    if (std::abs(sum - 1) <= probability_slack) return true;
    diagnostics_
        .error(
            first.source->probability->span,
            fmt::format("the probabilities of the productions that fit sum to {}, not to 1", shortest(sum)))
        .with_note(first.source->span, "this is the first of them");
    return false;
}

/// Whether the probabilities leave a share in which modules stay as they are, as in Houdini.
bool LsysRewriter::leaves_some(double sum, const LsysRule& first) {
    if (sum >= 1 - probability_slack || first.stays == LsysRule::none) return false;
    if (!std::exchange(noted_rest_, true))
        diagnostics_.note(
            first.source->probability->span,
            fmt::format("the probabilities of the productions that fit sum to {}: in the rest of "
                        "all cases the module stays as it is",
                        shortest(sum)));
    return true;
}

Fit LsysRewriter::apply(Alternative& alternative, std::span<const double> values, const Moment& moment) {
    const LsysRule& rule = *alternative.rule;
    const auto slots = slots_of(rule, values, moment);
    if (!slots) return Fit::error;
    const Fit fit = enter(alternative, moment, *slots);
    if (fit != Fit::yes || rule.draws > 0) return fit;
    const bool applied = rule.is_plain() || apply_slots(rule, moment, {}, slots_);
    return applied && append_by(rule, moment, *slots, alternative.successor) ? Fit::yes : Fit::error;
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

void LsysRewriter::fill_draws(const LsysRule& rule, RuleDraw draw, std::span<double> numbers) {
    if (pooled_) {
        const std::vector<double>& draws = draws_of(rule);
        for (std::uint32_t call = 0; call < rule.draws; ++call)
            numbers[call] = draws[call * draw_sets + draw.set];
        return;
    }
    const auto id = static_cast<std::size_t>(&rule - grammar_.rules.data());
    const CounterRandom random = CounterRandom(seed_).sequence(id).sequence(draw.own);
    for (std::uint32_t call = 0; call < rule.draws; ++call)
        numbers[call] = CounterRandom::unit(random(call));
}

bool LsysRewriter::apply_slots(const LsysRule& rule, const Moment& moment, RuleDraw draw,
                               std::vector<double>& slots, std::size_t first) {
    if (rule.draws > 0) fill_draws(rule, draw, std::span(slots).subspan(first + rule.slots.size()));
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

Fit LsysRewriter::enter(Competitor& competitor, const Moment& moment, std::span<const double> slots) {
    const LsysRule& rule = *competitor.rule;
    const std::span<const double> known = cells(rule.kind, moment.step);
    if (rule.condition) {
        const std::optional<double> truth = value(rule.condition->code, &rule, slots, known);
        if (!truth) return Fit::error;
        if (*truth == 0) return Fit::no;
    }
    if (!rule.probability) return Fit::yes;
    const std::optional<double> chance = value(*rule.probability, &rule, slots, known);
    if (!chance) return Fit::error;
    competitor.probability = *chance;
    if (*chance >= 0) return Fit::yes;
    diagnostics_.error(rule.source->probability->span,
                       fmt::format("a probability must not be negative, but is {}", shortest(*chance)));
    return Fit::error;
}

Fit LsysRewriter::enter_values(Competitor& competitor, std::span<const double> values, const Moment& moment) {
    const LsysRule& rule = *competitor.rule;
    if (!rule.condition && !rule.probability) return Fit::yes;
    const auto slots = slots_of(rule, values, moment);
    return slots ? enter(competitor, moment, *slots) : Fit::error;
}

bool LsysRewriter::append_successor(const LsysRule& rule, std::span<const double> values,
                                    const Moment& moment, RuleDraw draw, ModuleString& string) {
    if (rule.is_plain()) return append_by(rule, moment, values, string);
    const auto slots = slots_of(rule, values, moment);
    return slots && apply_slots(rule, moment, draw, slots_) && append_by(rule, moment, slots_, string);
}

bool LsysRewriter::append_by(const LsysRule& rule, const Moment& moment, std::span<const double> slots,
                             ModuleString& string) {
    return append(rule.successor, &rule, slots, cells(rule.kind, moment.step), string);
}

void LsysRewriter::report(const ExpressionCode& code, const LsysRule* rule, std::span<const double> slots,
                          std::span<const double> cells) {
    code.report(slots, grammar_.lets,
                rule ? std::span<const std::string_view>(rule->slots) : std::span<const std::string_view>(),
                diagnostics_, cells);
}

bool LsysRewriter::append(const std::vector<LsysTemplate>& templates, const LsysRule* rule,
                          std::span<const double> slots, std::span<const double> cells,
                          ModuleString& string) {
    const std::size_t known = modules_.size();
    const bool stamps = birth_ != ModuleTable::no_birth && (!rule || rule->kind != RuleKind::interpret);
    for (const LsysTemplate& module : templates) {
        arguments_.clear();
        for (const ExpressionCode& code : module.parameters) {
            const std::optional<double> argument = value(code, rule, slots, cells);
            if (!argument) return false;
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
