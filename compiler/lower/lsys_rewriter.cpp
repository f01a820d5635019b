#include "compiler/lower/lsys_rewriter.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "compiler/support/number.h"

namespace graftal {

namespace {

/// Probabilities as printed in books sum to 1 within this.
constexpr double probability_slack = 0.0101;

} // namespace

const Alternative& alternative_at(const std::vector<Alternative>& alternatives, double share) {
    const Alternative* chosen = &alternatives.front();
    for (const Alternative& alternative : alternatives) {
        if (alternative.probability <= 0) continue;
        chosen = &alternative;
        share -= alternative.probability;
        if (share < 0) break;
    }
    return *chosen;
}

std::optional<ModuleString> LsysRewriter::axiom() {
    ModuleString string;
    if (!append(grammar_.axiom, nullptr, {}, string)) return std::nullopt;
    return string;
}

const std::vector<Alternative>* LsysRewriter::alternatives(RuleKind kind, ModuleId module) {
    static const std::vector<Alternative> stays;
    const std::uint32_t found = find(kind, module);
    if (found == error) return nullptr;
    return found == none ? &stays : &alternatives_[found];
}

bool LsysRewriter::is_rewritten(RuleKind kind, ModuleId module) {
    return grammar_.has_rules(kind, modules_.symbol(module)) && find(kind, module) != none;
}

std::uint32_t LsysRewriter::find(RuleKind kind, ModuleId module) {
    auto& known = known_[static_cast<std::size_t>(kind)];
    if (known.size() <= module) known.resize(modules_.size() + modules_.size() / 2, unknown);
    if (known[module] != unknown) return known[module];
    const std::uint32_t computed = compute(kind, module);
    return known_[static_cast<std::size_t>(kind)][module] = computed;
}

std::uint32_t LsysRewriter::compute(RuleKind kind, ModuleId module) {
    const auto& rules = grammar_.candidates(kind, modules_.symbol(module));
    if (rules.empty()) return none;
    std::vector<Alternative> found;
    if (!collect(rules, module, found)) {
        failed_ = true;
        return error;
    }
    if (found.empty()) return none;
    alternatives_.push_back(std::move(found));
    return static_cast<std::uint32_t>(alternatives_.size() - 1);
}

bool LsysRewriter::collect(const std::vector<std::uint32_t>& rules, ModuleId module,
                           std::vector<Alternative>& found) {
    const auto parameters = modules_.parameters(module);
    const std::vector<double> values(parameters.begin(), parameters.end());
    const auto first = try_rules(rules, values.size(), [&](const LsysRule& rule) {
        if (rule.has_context()) return Fit::no;
        Alternative alternative;
        const Fit fit = apply(rule, values, alternative);
        if (fit == Fit::yes) found.push_back(std::move(alternative));
        return fit;
    });
    if (!first) return false;
    return !*first || !(*first)->probability || normalise(found, **first);
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

Fit LsysRewriter::apply(const LsysRule& rule, std::span<const double> values, Alternative& result) {
    const std::size_t errors = diagnostics_.error_count();
    if (!condition_holds(rule, values)) return diagnostics_.error_count() > errors ? Fit::error : Fit::no;
    const std::optional<double> chance = probability(rule, values);
    if (!chance) return Fit::error;
    result.rule = &rule;
    result.probability = *chance;
    result.successor.clear();
    return append_successor(rule, values, result.successor) ? Fit::yes : Fit::error;
}

bool LsysRewriter::condition_holds(const LsysRule& rule, std::span<const double> values) {
    if (!rule.condition) return true;
    const std::optional<double> truth = value(*rule.condition, rule, values);
    return truth && *truth != 0;
}

std::optional<double> LsysRewriter::probability(const LsysRule& rule, std::span<const double> values) {
    if (!rule.probability) return 1;
    const std::optional<double> chance = value(*rule.probability, rule, values);
    if (!chance || *chance >= 0) return chance;
    diagnostics_.error(rule.source->probability->span,
                       fmt::format("a probability must not be negative, but is {}", shortest(*chance)));
    return std::nullopt;
}

bool LsysRewriter::append_successor(const LsysRule& rule, std::span<const double> values,
                                    ModuleString& string) {
    return append(rule.successor, &rule, values, string);
}

std::optional<double> LsysRewriter::value(const ExpressionCode& code, const LsysRule& rule,
                                          std::span<const double> values) {
    const std::optional<double> result = code.value(values);
    if (!result) code.report(values, grammar_.lets, rule.variables, diagnostics_);
    return result;
}

bool LsysRewriter::append(const std::vector<LsysTemplate>& templates, const LsysRule* rule,
                          std::span<const double> values, ModuleString& string) {
    for (const LsysTemplate& module : templates) {
        arguments_.clear();
        for (const ExpressionCode& code : module.parameters) {
            const std::optional<double> argument = code.value(values);
            if (!argument) {
                code.report(values, grammar_.lets,
                            rule ? std::span<const std::string_view>(rule->variables)
                                 : std::span<const std::string_view>(),
                            diagnostics_);
                return false;
            }
            arguments_.push_back(*argument);
        }
        string.push_back(modules_.intern(module.symbol, arguments_));
    }
    if (modules_.size() <= max_distinct_modules) return true;
    diagnostics_
        .error(rule ? rule->source->span : grammar_.source->name.span,
               fmt::format("more than {} different modules are derived", max_distinct_modules))
        .with_hint("parameters that change without end make every module another one");
    return false;
}

} // namespace graftal
