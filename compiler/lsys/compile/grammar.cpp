#include "compiler/lsys/compile/grammar.h"

#include <algorithm>
#include <set>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "compiler/lsys/compile/checks.h"
#include "compiler/lsys/compile/declarations.h"
#include "compiler/lsys/compile/settings.h"
#include "compiler/lsys/compile/surroundings.h"
#include "compiler/lsys/parse/commands.h"
#include "compiler/syntax/write_out.h"

namespace graftal {

namespace {

constexpr std::size_t most_symbols = 0xFFFF;

/// Polygons need not be balanced in a string; branches only where the predecessor's are not. A string without
/// braces moves no bracket past one.
bool polygons_cross_branches(const LsysString& string) {
    const auto is_brace = [](const LsysModule& module) {
        return module.symbol == "{" || module.symbol == "}";
    };
    if (std::ranges::none_of(string.modules, is_brace)) return false;
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
        grammar_.cells = std::make_shared<CellPlaces>(
            declare_variables(block_, grammar_.lets, grammar_.first_cells, diagnostics_));
        build_settings(block_, grammar_, diagnostics_);
        add_step_programs();
        if (block_.axiom) grammar_.axiom = templates(*block_.axiom, {}, nullptr);
        add_rules(block_.productions, RuleKind::produce);
        add_rules(block_.decompose, RuleKind::decompose);
        add_rules(block_.interpret, RuleKind::interpret);
        add_filter();
        for (auto& rules : grammar_.rules_of)
            rules.resize(grammar_.symbols.size());
        note_times();
        if (!block_.precedence || !block_.precedence->by_text) prefer_contexts();
        check_grammar(grammar_, uses_, diagnostics_);
        build_surroundings(block_, grammar_, diagnostics_);
        grammar_.needs_word |= grammar_.has_queries();
        if (diagnostics_.error_count() > errors_before_) return std::nullopt;
        add_stay_rules();
        return std::move(grammar_);
    }

  private:
    void add_step_programs() {
        const auto add = [&](const std::optional<LsysCommands>& commands, LsysProgram& program) {
            if (!commands) return;
            const LsysProgramNames names{grammar_.lets, *grammar_.cells, step_slots, &grammar_.step_draws};
            program = compile_program(*commands, names, diagnostics_);
        };
        add(block_.start, grammar_.start);
        add(block_.start_each, grammar_.start_each);
        add(block_.end_each, grammar_.end_each);
        add(block_.end, grammar_.end);
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
                if (auto code = ExpressionCode::compile(parameter, grammar_.lets, variables, diagnostics_,
                                                        draws, grammar_.cells.get()))
                    added.parameters.push_back(std::move(*code));
        }
        grammar_.polygons_cross_branches |= polygons_cross_branches(string);
        return result;
    }

    LsysPattern pattern(const LsysFormal& formal, LsysRule& rule) {
        for (const Name& name : formal.parameters)
            rule.variables.push_back(name.text); // the parser has seen to it that they differ
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
        for (const LsysFormal& formal : production.following)
            rule.following.push_back(pattern(formal, rule));
        for (const LsysFormal& formal : production.left)
            rule.left.push_back(pattern(formal, rule));
        for (const LsysFormal& formal : production.right)
            rule.right.push_back(pattern(formal, rule));
        if (name_slots(rule)) compile(rule);
        rule.time = time_of(rule);
        grammar_.in_order |= rule.in_order();
        grammar_.needs_word |= rule.sees_word() || rule.in_order();
        grammar_.is_stochastic |= rule.is_random();
        auto& of_kind = grammar_.rules_of[static_cast<std::size_t>(kind)];
        if (of_kind.size() <= rule.predecessor.symbol) of_kind.resize(rule.predecessor.symbol + 1u);
        of_kind[rule.predecessor.symbol].push_back(static_cast<std::uint32_t>(grammar_.rules.size()));
        grammar_.rules.push_back(std::move(rule));
    }

    /// For each production with a probability, one that leaves its module as it is; but not where modules
    /// have ages, since it gives a new module.
    void add_stay_rules() {
        const auto productions = std::make_shared<std::deque<LsysProduction>>();
        const std::size_t count = grammar_.rules.size();
        for (std::size_t i = 0; i < count; ++i) {
            const LsysProduction& source = *grammar_.rules[i].source;
            const LsysPattern predecessor = grammar_.rules[i].predecessor;
            const TurtleCommand command = grammar_.commands[predecessor.symbol];
            if (grammar_.rules[i].kind != RuleKind::produce || !source.probability ||
                grammar_.ages[predecessor.symbol] || command == TurtleCommand::model ||
                command == TurtleCommand::open_branch || command == TurtleCommand::close_branch)
                continue;
            LsysModule same{.symbol = source.predecessor.symbol, .span = source.span};
            for (const Name& name : source.predecessor.parameters) {
                Expression& parameter = same.parameters.emplace_back();
                parameter.kind = Expression::Kind::name;
                parameter.text = name.text;
                parameter.span = name.span;
            }
            LsysProduction& stays = productions->emplace_back();
            stays.predecessor = source.predecessor;
            stays.successor = {{std::move(same)}, source.span};
            stays.span = source.span;
            LsysRule rule;
            rule.source = &stays;
            rule.keeps = true;
            rule.predecessor = pattern(stays.predecessor, rule);
            if (name_slots(rule)) compile(rule);
            grammar_.rules[i].stays = static_cast<std::uint32_t>(grammar_.rules.size());
            grammar_.rules.push_back(std::move(rule));
        }
        grammar_.stay_productions = productions;
    }

    /// The names that blocks assign and that mean nothing else are local values. Of too many it gives some.
    std::vector<const LsysCommand*> locals_of(const std::optional<LsysCommands>& block,
                                              const LsysRule& rule) {
        std::vector<const LsysCommand*> locals;
        if (!block) return locals;
        for_each_assignment(block->list, [&](const LsysCommand& command) {
            if (locals.size() > max_lsys_parameters) return;
            const std::string_view name = command.target;
            const auto is_known = [&](std::string_view other) { return other == name; };
            const bool known =
                std::ranges::any_of(rule.variables, is_known) ||
                std::ranges::any_of(locals, [&](auto* other) { return other->target == name; });
            if (!known && command.indices.empty() && name != "pi" && !grammar_.lets.contains(name) &&
                !grammar_.cells->contains(name))
                locals.push_back(&command);
        });
        return locals;
    }

    /// False after the error that there are too many.
    bool name_slots(LsysRule& rule) {
        locals_ = locals_of(rule.source->before, rule);
        locals_before_ = locals_.size();
        for (const LsysCommand* local : locals_of(rule.source->after, rule))
            if (std::ranges::none_of(locals_, [&](auto* other) { return other->target == local->target; }))
                locals_.push_back(local);
        if (locals_.size() > max_lsys_parameters) {
            diagnostics_.error(locals_[max_lsys_parameters]->span,
                               fmt::format("a production has at most {} local values", max_lsys_parameters));
            return false;
        }
        rule.slots = rule.variables;
        for (const std::string_view name : {"step", "age"})
            rule.slots.push_back(is_taken(name, rule) ? std::string_view() : name);
        for (const LsysCommand* local : locals_)
            rule.slots.push_back(local->target);
        return true;
    }

    /// Names of the model hide those of the time.
    bool is_taken(std::string_view name, const LsysRule& rule) const {
        return grammar_.lets.contains(name) ||
               std::ranges::find(rule.variables, name) != rule.variables.end() ||
               std::ranges::any_of(locals_, [&](auto* local) { return local->target == name; });
    }

    /// Compiles a rule. Expressions before its application know only the local values of the first block.
    void compile(LsysRule& rule) {
        const LsysProduction& source = *rule.source;
        std::vector<std::string_view> early = rule.slots;
        std::fill(early.end() - static_cast<std::ptrdiff_t>(locals_.size() - locals_before_), early.end(),
                  std::string_view());
        const bool draws = rule.kind != RuleKind::interpret;
        const LsysProgramNames before{grammar_.lets, *grammar_.cells, early, draws ? &rule.draws : nullptr};
        const bool refused = !draws && refuse_chance(source);
        if (source.before && !refused) rule.before = compile_program(*source.before, before, diagnostics_);
        if (source.condition && !refused)
            rule.condition = compile_formula(*source.condition, before, diagnostics_);
        if (source.probability)
            rule.probability = ExpressionCode::compile(*source.probability, grammar_.lets, early,
                                                       diagnostics_, nullptr, grammar_.cells.get());
        const LsysProgramNames after{grammar_.lets, *grammar_.cells, rule.slots, &rule.draws, false};
        if (source.after) rule.after = compile_program(*source.after, after, diagnostics_);
        rule.successor = templates(source.successor, rule.slots, &rule.draws);
        if (!draws) check_drawing(rule);
        warn_of_idle_locals(rule);
    }

    /// Refuses chance in a production that draws, since drawing has no order. Whether it reported that.
    bool refuse_chance(const LsysProduction& source) {
        const std::size_t errors = diagnostics_.error_count();
        const auto check = [&](const Expression& e) {
            if (calls_chance(e))
                diagnostics_.error(e.span, "chance does not decide here how a module is drawn")
                    .with_hint("in 'interpret', random numbers stand in successors, or in a block behind the "
                               "condition");
        };
        if (source.condition) check(*source.condition);
        if (source.before) for_each_expression(source.before->list, check);
        return diagnostics_.error_count() > errors;
    }

    void check_drawing(const LsysRule& rule) {
        for (const auto* block : {&rule.source->before, &rule.source->after}) {
            if (!*block) continue;
            for_each_assignment((*block)->list, [&](const LsysCommand& command) {
                if (std::ranges::find(rule.slots, command.target) == rule.slots.end() &&
                    grammar_.cells->contains(command.target))
                    diagnostics_
                        .error(command.span,
                               fmt::format("a drawing cannot change the variable '{}'", command.target))
                        .with_hint("productions of 'interpret' may set local values only");
            });
        }
        if (rule.after.draws_anew)
            diagnostics_.error(rule.source->after->span, "random numbers in a loop cannot be drawn here")
                .with_hint("a block of 'interpret' draws its random numbers once");
    }

    void warn_of_idle_locals(const LsysRule& rule) {
        for (std::size_t i = 0; i < locals_.size(); ++i) {
            const std::size_t slot = rule.variables.size() + 2 + i;
            const auto reads = [&](const ExpressionCode& code) { return code.reads(slot); };
            const bool is_read = rule.before.reads(slot) || rule.after.reads(slot) ||
                                 (rule.condition && reads(rule.condition->code)) ||
                                 (rule.probability && reads(*rule.probability)) ||
                                 std::ranges::any_of(rule.successor, [&](const LsysTemplate& module) {
                                     return std::ranges::any_of(module.parameters, reads);
                                 });
            if (is_read) continue;
            Diagnostic& warning = diagnostics_.warning(
                locals_[i]->span, fmt::format("nothing reads the local value '{}'", locals_[i]->target));
            if (++idle_locals_ > Diagnostics::max_errors) continue; // nobody sees its hint
            std::vector<std::string> known;
            for (const auto& [name, place] : *grammar_.cells)
                known.push_back(name);
            warning.with_hint(known.empty() ? "a variable keeps its value for others: variable NAME = 0"
                                            : choices(locals_[i]->target, known));
        }
    }

    static TimeMask time_of(const LsysRule& rule) {
        TimeMask time = 0;
        const auto note = [&](const auto& code) {
            if (code.reads(rule.variables.size())) time |= reads_step;
            if (code.reads(rule.variables.size() + 1)) time |= reads_age;
            if (code.reads_changing_cells()) time |= reads_variables;
        };
        note(rule.before);
        note(rule.after);
        if (rule.condition) note(rule.condition->code);
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
        hand_on_ages();
    }

    /// A module that is drawn as one with an age has an age too. O(modules of the rules).
    void hand_on_ages() {
        std::vector<std::vector<SymbolId>> drawn_as(grammar_.symbols.size());
        for (const LsysRule& rule : grammar_.rules)
            if (rule.kind == RuleKind::interpret)
                for (const LsysTemplate& module : rule.successor)
                    drawn_as[module.symbol].push_back(rule.predecessor.symbol);
        std::vector<SymbolId> aged;
        for (std::size_t symbol = 0; symbol < grammar_.ages.size(); ++symbol)
            if (grammar_.ages[symbol]) aged.push_back(static_cast<SymbolId>(symbol));
        while (!aged.empty()) {
            const SymbolId symbol = aged.back();
            aged.pop_back();
            for (const SymbolId whole : drawn_as[symbol])
                if (!grammar_.ages[whole]) grammar_.ages[whole] = true, aged.push_back(whole);
        }
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

    const LsysBlock& block_;
    Diagnostics& diagnostics_;
    std::size_t errors_before_;
    LsysGrammar grammar_;
    std::unordered_map<std::string, SymbolId> ids_;
    std::vector<LsysUse> uses_;              ///< in axiom and successors
    std::vector<const LsysCommand*> locals_; ///< of the rule that is added: the first assignment to each
    std::size_t locals_before_ = 0;          ///< number of locals of its first block
    std::size_t idle_locals_ = 0;            ///< that were warned of
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
