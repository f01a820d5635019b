#include "compiler/lsys/lsys_grammar.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "compiler/lower/lower_transform.h"
#include "compiler/support/number.h"
#include "compiler/support/number_range.h"

namespace graftal {

namespace {

constexpr std::size_t most_symbols = 0xFFFF;
constexpr double largest_seed = 9007199254740992.0; // 2^53

/// Branches are balanced in every string; polygons need not be.
bool polygons_cross_branches(const LsysString& string) {
    std::string open;
    for (const LsysModule& module : string.modules) {
        if (module.symbol == "[" || module.symbol == "{") open += module.symbol;
        if (module.symbol != "]" && module.symbol != "}") continue;
        if (open.empty() || open.back() != (module.symbol == "]" ? '[' : '{')) return true;
        open.pop_back();
    }
    return !open.empty();
}

class GrammarBuilder {
  public:
    GrammarBuilder(const LsysBlock& block, Environment lets, Diagnostics& diagnostics)
        : block_(block), diagnostics_(diagnostics), errors_before_(diagnostics.error_count()) {
        grammar_.source = &block;
        grammar_.lets = std::move(lets);
    }

    std::optional<LsysGrammar> run() && {
        add_settings();
        if (block_.axiom) grammar_.axiom = templates(*block_.axiom, {}, nullptr);
        add_rules(block_.productions, RuleKind::produce);
        add_rules(block_.decompose, RuleKind::decompose);
        add_rules(block_.interpret, RuleKind::interpret);
        add_filter();
        for (auto& rules : grammar_.rules_of)
            rules.resize(grammar_.symbols.size());
        note_times();
        prefer_contexts();
        check_symbols();
        if (!block_.broken) check_contexts();
        if (diagnostics_.error_count() > errors_before_) return std::nullopt;
        return std::move(grammar_);
    }

  private:
    template<typename Predicate>
    std::optional<double> setting(const std::optional<LsysValue>& value, const Predicate& good,
                                  std::string_view name, std::string_view demand) {
        if (!value) return std::nullopt;
        return checked(value->value, good, name, demand);
    }

    template<typename Predicate>
    std::optional<double> checked(const Expression& expression, const Predicate& good, std::string_view name,
                                  std::string_view demand) {
        const std::optional<double> number = evaluate(expression, grammar_.lets, diagnostics_);
        if (!number || good(*number)) return number;
        diagnostics_.error(expression.span,
                           fmt::format("'{}' must {}, not {}", name, demand, shortest(*number)));
        return std::nullopt;
    }

    /// A size that the turtle can take.
    std::optional<double> size(const std::optional<LsysValue>& value, std::string_view name) {
        const auto known = setting(
            value, [](double x) { return x > 0; }, name, "be positive");
        if (!known || (*known >= least_size && *known <= largest_size)) return known;
        diagnostics_.error(value->value.span,
                           fmt::format("'{}' must lie between {} and {}, not {}", name, shortest(least_size),
                                       shortest(largest_size), shortest(*known)));
        return std::nullopt;
    }

    void add_settings() {
        const auto any = [](double) { return true; };
        grammar_.angle_deg = setting(block_.angle, any, "angle", "").value_or(grammar_.angle_deg);
        grammar_.step = size(block_.step, "step").value_or(grammar_.step);
        grammar_.width = size(block_.width, "width");
        grammar_.thickness = size(block_.thickness, "thickness");
        grammar_.thinnest = size(block_.thinnest, "thinnest").value_or(0);
        if (block_.thinnest && !block_.thickness)
            diagnostics_.error(block_.thinnest->span, "'thinnest' is the least width beside a 'thickness'");
        if (block_.width && block_.thickness)
            diagnostics_.error(block_.thickness->span, "a block has a 'width' or a 'thickness'")
                .with_note(block_.width->span, "the width is here");
        const auto seed = setting(
            block_.seed, [](double x) { return x >= 0 && x <= largest_seed && x == std::floor(x); }, "seed",
            "be a whole number from 0 to 2^53");
        grammar_.seed = static_cast<std::uint64_t>(seed.value_or(0));
        if (block_.tropism) set_direction(*block_.tropism, "tropism", grammar_.tropism);
        if (block_.vertical) set_direction(*block_.vertical, "vertical", grammar_.vertical);
        if (!block_.steps) return;
        grammar_.infinite = !block_.steps->value;
        if (grammar_.infinite) return;
        const auto steps = checked(
            *block_.steps->value,
            [](double x) { return x >= 0 && x <= max_derivation_steps && x == std::floor(x); }, "steps",
            fmt::format("be a whole number from 0 to {}, or infinite", max_derivation_steps));
        if (steps) grammar_.steps = static_cast<unsigned>(*steps);
    }

    void set_direction(const LsysDirection& statement, std::string_view name, Vec3& direction) {
        const std::optional<Vec3> given = lower_vector(statement.direction, grammar_.lets, diagnostics_);
        if (!given) return;
        const double length = glm::length(*given);
        if (length > 0 && std::isfinite(length))
            direction = *given / length;
        else
            diagnostics_.error(statement.span, fmt::format("'{}' must have a direction", name));
    }

    SymbolId symbol(std::string_view name, Span span) {
        const auto [known, fresh] = ids_.try_emplace(std::string(name), static_cast<SymbolId>(ids_.size()));
        if (!fresh) return known->second;
        if (grammar_.symbols.size() == most_symbols) { // more would have no number
            diagnostics_.error(span, fmt::format("a block has at most {} different symbols", most_symbols));
            return known->second = 0;
        }
        grammar_.symbols.push_back(known->first);
        grammar_.commands.push_back(turtle_command(name));
        grammar_.first_uses.push_back(span);
        return known->second;
    }

    SymbolId symbol(const LsysModule& module) {
        if (module.symbol != "~") return symbol(module.symbol, module.span);
        return symbol(fmt::format("~{}", module.model), module.span);
    }

    /// `draws`: counts random numbers; null where there are none.
    std::vector<LsysTemplate> templates(const LsysString& string,
                                        const std::vector<std::string_view>& variables,
                                        std::uint32_t* draws) {
        std::vector<LsysTemplate> result;
        result.reserve(string.modules.size());
        for (const LsysModule& module : string.modules) {
            LsysTemplate& added = result.emplace_back();
            added.symbol = symbol(module);
            uses_.push_back({added.symbol, module.parameters.size(), module.span});
            for (const Expression& parameter : module.parameters)
                if (auto code =
                        ExpressionCode::compile(parameter, grammar_.lets, variables, diagnostics_, draws))
                    added.parameters.push_back(std::move(*code));
        }
        grammar_.polygons_cross_branches |= polygons_cross_branches(string);
        return result;
    }

    LsysPattern pattern(const LsysFormal& formal, LsysRule& rule) {
        for (const Name& name : formal.parameters) {
            rule.variables.push_back(name.text); // the parser has seen to it that they differ
        }
        return {symbol(formal.symbol, formal.span), static_cast<std::uint16_t>(formal.parameters.size())};
    }

    void add_rules(const std::vector<LsysProduction>& productions, RuleKind kind) {
        for (const LsysProduction& production : productions) {
            if (diagnostics_.full()) return;
            add_rule(production, kind);
        }
    }

    void add_rule(const LsysProduction& production, RuleKind kind) {
        LsysRule rule;
        rule.source = &production;
        rule.kind = kind;
        rule.predecessor = pattern(production.predecessor, rule);
        for (const LsysFormal& formal : production.left)
            rule.left.push_back(pattern(formal, rule));
        for (const LsysFormal& formal : production.right)
            rule.right.push_back(pattern(formal, rule));
        rule.slots = rule.variables;
        for (const std::string_view name : {"step", "age"})
            rule.slots.push_back(is_taken(name, rule) ? std::string_view() : name);
        rule.condition = code(production.condition, rule);
        rule.probability = code(production.probability, rule);
        rule.successor = templates(production.successor, rule.slots, &rule.draws);
        rule.time = time_of(rule);
        grammar_.has_context |= rule.has_context();
        grammar_.is_stochastic |= rule.is_random();
        auto& of_kind = grammar_.rules_of[static_cast<std::size_t>(kind)];
        if (of_kind.size() <= rule.predecessor.symbol) of_kind.resize(rule.predecessor.symbol + 1u);
        of_kind[rule.predecessor.symbol].push_back(static_cast<std::uint32_t>(grammar_.rules.size()));
        grammar_.rules.push_back(std::move(rule));
    }

    std::optional<ExpressionCode> code(const std::optional<Expression>& expression, const LsysRule& rule) {
        if (!expression) return std::nullopt;
        return ExpressionCode::compile(*expression, grammar_.lets, rule.slots, diagnostics_);
    }

    /// Names of the model hide those of the time.
    bool is_taken(std::string_view name, const LsysRule& rule) const {
        return grammar_.lets.contains(name) ||
               std::ranges::find(rule.variables, name) != rule.variables.end();
    }

    static TimeMask time_of(const LsysRule& rule) {
        TimeMask time = 0;
        const auto note = [&](const ExpressionCode& code) {
            if (code.reads(rule.variables.size())) time |= reads_step;
            if (code.reads(rule.variables.size() + 1)) time |= reads_age;
        };
        if (rule.condition) note(*rule.condition);
        if (rule.probability) note(*rule.probability);
        for (const LsysTemplate& module : rule.successor)
            std::ranges::for_each(module.parameters, note);
        return time;
    }

    void note_times() {
        for (std::size_t kind = 0; kind < rule_kind_count; ++kind) {
            for (const auto& rules : grammar_.rules_of[kind]) {
                TimeMask time = 0;
                for (const std::uint32_t rule : rules)
                    time |= grammar_.rules[rule].time;
                grammar_.time_of[kind].push_back(time);
            }
        }
        grammar_.ages.assign(grammar_.symbols.size(), false);
        for (const auto& times : grammar_.time_of)
            for (std::size_t symbol = 0; symbol < times.size(); ++symbol)
                if (times[symbol] & reads_age) grammar_.ages[symbol] = true;
        while (hand_on_ages()) {
        }
    }

    /// What a module is drawn as has the age of the module. True if that made a symbol one of these.
    bool hand_on_ages() {
        bool changed = false;
        for (const LsysRule& rule : grammar_.rules) {
            if (rule.kind != RuleKind::interpret || grammar_.ages[rule.predecessor.symbol]) continue;
            changed |= grammar_.ages[rule.predecessor.symbol] = std::ranges::any_of(
                rule.successor, [&](const LsysTemplate& module) { return grammar_.ages[module.symbol]; });
        }
        return changed;
    }

    void add_filter() {
        std::set<SymbolId> named;
        if (block_.filter)
            for (const Name& name : block_.filter->symbols)
                named.insert(symbol(name.text, name.span));
        const auto is_model = [&](SymbolId id) { return grammar_.symbols[id].starts_with('~'); };
        const auto is_named = [&](SymbolId id) {
            return named.contains(id) || (is_model(id) && ids_.contains("~") && named.contains(ids_.at("~")));
        };
        const bool consider = block_.filter && block_.filter->consider;
        grammar_.ignored.resize(grammar_.symbols.size());
        for (SymbolId id = 0; id < grammar_.symbols.size(); ++id)
            grammar_.ignored[id] = block_.filter && is_named(id) != consider;
    }

    void prefer_contexts() {
        for (auto& rules : grammar_.rules_of)
            for (auto& of_symbol : rules)
                std::stable_partition(of_symbol.begin(), of_symbol.end(),
                                      [&](std::uint32_t id) { return grammar_.rules[id].has_context(); });
    }

    bool is_rewritten(SymbolId id) const {
        return std::ranges::any_of(grammar_.rules_of, [&](const auto& rules) { return !rules[id].empty(); });
    }

    bool is_rewritten(SymbolId id, std::size_t arity) const {
        return std::ranges::any_of(grammar_.rules_of, [&](const auto& rules) {
            return std::ranges::any_of(rules[id], [&](std::uint32_t rule) {
                return grammar_.rules[rule].predecessor.arity == arity;
            });
        });
    }

    /// Such a production never fits; it is spoken of once.
    void check_contexts() {
        std::set<std::pair<SymbolId, std::size_t>> known;
        std::set<SymbolId> symbols;
        for (const Use& use : uses_) {
            known.emplace(use.symbol, use.arity);
            symbols.insert(use.symbol);
        }
        const auto matches = [&](const LsysPattern& pattern, const LsysFormal& source) {
            std::string problem;
            if (grammar_.ignored[pattern.symbol] && !is_bracket(pattern.symbol))
                problem = fmt::format("contexts skip '{}'", source.symbol);
            else if (!symbols.contains(pattern.symbol))
                problem = fmt::format("no axiom or successor has a module '{}'", source.symbol);
            else if (!known.contains({pattern.symbol, pattern.arity}))
                problem = fmt::format("no axiom or successor has a module '{}' with {}", source.symbol,
                                      count(pattern.arity));
            if (problem.empty()) return true;
            diagnostics_.warning(source.span, std::move(problem)).with_hint("this context never matches");
            return false;
        };
        for (const LsysRule& rule : grammar_.rules)
            if (std::ranges::equal(rule.left, rule.source->left, matches))
                std::ranges::equal(rule.right, rule.source->right, matches);
    }

    bool is_bracket(SymbolId id) const {
        return grammar_.commands[id] == TurtleCommand::open_branch ||
               grammar_.commands[id] == TurtleCommand::close_branch;
    }

    static std::string count(std::size_t parameters) {
        return fmt::format("{} parameter{}", parameters == 0 ? "no" : std::to_string(parameters),
                           parameters == 1 ? "" : "s");
    }

    /// Each symbol, and each number of parameters of it, is spoken of once.
    void check_symbols() {
        std::set<SymbolId> seen_by_contexts;
        for (const LsysRule& rule : grammar_.rules)
            for (const auto* context : {&rule.left, &rule.right})
                for (const LsysPattern& pattern : *context)
                    seen_by_contexts.insert(pattern.symbol);
        std::set<std::string_view> declared;
        for (const Name& module : block_.modules)
            declared.insert(module.text);
        std::set<std::pair<SymbolId, std::size_t>> checked;
        Word word;
        for (const Use& use : uses_) {
            const std::string& name = grammar_.symbols[use.symbol];
            if (!is_letter(name) || use.span.begin != word.end) finish(word);
            word.text += name;
            word.end = use.arity == 0 ? use.span.end : 0;
            const bool rewritten = is_rewritten(use.symbol);
            if (grammar_.commands[use.symbol] != TurtleCommand::none) continue;
            if (!checked.emplace(use.symbol, rewritten ? use.arity : 0).second) continue;
            if (rewritten) {
                if (!block_.broken && !is_rewritten(use.symbol, use.arity)) warn_of_arity(use, name);
            } else if (!is_letter(name)) {
                diagnostics_.error(use.span, fmt::format("'{}' means nothing to the turtle", name))
                    .with_hint(name == "\""
                                   ? "write strings of modules without quotes: axiom F"
                                   : "use letters for modules; docs/language.md lists the turtle's symbols");
            } else if (!seen_by_contexts.contains(use.symbol) && !declared.contains(name)) {
                word.idle.push_back(&use);
            }
        }
        finish(word);
    }

    struct Use {
        SymbolId symbol;
        std::size_t arity;
        Span span;
    };

    /// Letters that follow each other without anything between them: one name, perhaps, read letter by
    /// letter.
    struct Word {
        std::string text;
        std::uint32_t end = 0;        ///< where the next letter would stand; 0: nowhere
        std::vector<const Use*> idle; ///< modules without a production, not spoken of before
    };

    /// Without what could not be read, nobody knows which modules have a production.
    void finish(Word& word) {
        if (!word.idle.empty() && !block_.broken) warn_of_idle(word);
        word = {};
    }

    void warn_of_idle(const Word& word) {
        std::string quoted, names;
        for (const Use* use : word.idle) {
            const std::string& name = grammar_.symbols[use->symbol];
            quoted += fmt::format("{}'{}'",
                                  quoted.empty()            ? ""
                                  : use == word.idle.back() ? " and "
                                                            : ", ",
                                  name);
            names += " " + name;
        }
        const Span span = join(word.idle.front()->span, word.idle.back()->span);
        if (word.idle.size() == 1) {
            diagnostics_.warning(span, fmt::format("{} has no production and draws nothing", quoted))
                .with_hint(fmt::format("write 'modules{}' if you mean this", names));
            return;
        }
        std::vector<std::string> declared;
        for (const Name& module : block_.modules)
            declared.emplace_back(module.text);
        const std::string meant = did_you_mean(word.text, declared);
        diagnostics_.warning(span, fmt::format("{} have no production and draw nothing", quoted))
            .with_hint(
                !meant.empty()
                    ? meant
                    : fmt::format(
                          "write 'modules {}' to make one name of them, or 'modules{}' if you mean this",
                          word.text, names));
    }

    void warn_of_arity(const Use& use, const std::string& name) {
        std::set<std::size_t> known;
        for (const auto& rules : grammar_.rules_of)
            for (const std::uint32_t rule : rules[use.symbol])
                known.insert(grammar_.rules[rule].predecessor.arity);
        diagnostics_
            .warning(use.span, fmt::format("no production rewrites '{}' with {}", name, count(use.arity)))
            .with_hint(fmt::format("its productions have {}", count(*known.begin())));
    }

    static bool is_letter(const std::string& name) {
        return std::isalnum(static_cast<unsigned char>(name.front())) || name.front() == '_';
    }

    const LsysBlock& block_;
    Diagnostics& diagnostics_;
    std::size_t errors_before_;
    LsysGrammar grammar_;
    std::unordered_map<std::string, SymbolId> ids_;
    std::vector<Use> uses_; ///< in axiom and successors
};

} // namespace

bool LsysGrammar::is_rewritten(SymbolId symbol) const {
    return std::ranges::any_of(rules_of, [&](const auto& of_kind) { return !of_kind[symbol].empty(); });
}

bool LsysGrammar::has_rules(RuleKind kind) const {
    return std::ranges::any_of(rules_of[static_cast<std::size_t>(kind)],
                               [](const auto& of_symbol) { return !of_symbol.empty(); });
}

TimeMask LsysGrammar::time(RuleKind kind) const {
    TimeMask all = 0;
    for (const TimeMask time : time_of[static_cast<std::size_t>(kind)])
        all |= time;
    return all;
}

bool LsysGrammar::draws(RuleKind kind) const {
    return std::ranges::any_of(rules,
                               [&](const LsysRule& rule) { return rule.kind == kind && rule.draws > 0; });
}

bool LsysGrammar::is_random(RuleKind kind) const {
    return std::ranges::any_of(rules,
                               [&](const LsysRule& rule) { return rule.kind == kind && rule.is_random(); });
}

bool LsysGrammar::uses(std::initializer_list<TurtleCommand> wanted) const {
    return std::ranges::any_of(
        commands, [&](TurtleCommand command) { return std::ranges::find(wanted, command) != wanted.end(); });
}

std::optional<LsysGrammar> build_grammar(const LsysBlock& block, Environment lets, Diagnostics& diagnostics) {
    return GrammarBuilder(block, std::move(lets), diagnostics).run();
}

} // namespace graftal
