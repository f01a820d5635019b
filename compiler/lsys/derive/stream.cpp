#include "compiler/lsys/derive/stream.h"

#include <algorithm>

#include "compiler/lsys/derive/word.h"

namespace graftal {

namespace {

/// The random sequence of a seed that interprets; those of the steps choose productions.
constexpr std::uint64_t interpreting = UINT64_MAX - 1;
/// Most interpretations that may follow each other.
constexpr std::uint32_t most_interpretations = 1000;

} // namespace

bool LsysStream::can_derive(const LsysGrammar& grammar) {
    return !grammar.needs_word && !grammar.has_rules(RuleKind::decompose) &&
           !grammar.uses({TurtleCommand::cut});
}

bool LsysStream::can_draw(const LsysGrammar& grammar) {
    return !grammar.draws_in_time() || !grammar.is_random(RuleKind::interpret);
}

LsysStream::LsysStream(LsysRewriter& rewriter, const ModelPlacer& models, Diagnostics& diagnostics,
                       const Options& options)
    : rewriter_(rewriter), grammar_(rewriter.grammar()), models_(models), diagnostics_(diagnostics),
      options_(options), random_(options.seed), chooses_(grammar_.is_random(RuleKind::produce)),
      in_word_(options.steps + std::size_t{1}), staying_(options.steps + std::size_t{2}) {}

bool LsysStream::derive(Turtle& turtle) {
    turtle_ = &turtle;
    return count();
}

bool LsysStream::count() {
    if (!rewriter_.prepare(options_.steps)) return false;
    frames_.push_back({.string = &grammar_.axiom, .cells = rewriter_.cells(RuleKind::produce, 0)});
    return run();
}

/// Until no string is under way.
bool LsysStream::run() {
    while (!frames_.empty()) {
        Frame& frame = frames_.back();
        if (frame.at == frame.string->size()) {
            values_.resize(frame.slots);
            const bool ends_module = frame.repeated == 1;
            frames_.pop_back();
            if (witness_ && ends_module) witness_->ends(*turtle_);
            continue;
        }
        rewriter_.work();
        Module module;
        if (!read_module(frame, module)) return false;
        // The frame may move now.
        const std::size_t slots_end = frame.slots + frame.slot_count, depth = frames_.size();
        if (!(frame.interprets ? emit(module, frame.repeated) : meet(module, frame.word))) return false;
        if (frames_.size() == depth) values_.resize(slots_end);
    }
    return true;
}

/// The next of a string, its parameters at the end of values_.
bool LsysStream::read_module(Frame& frame, Module& module) {
    const LsysTemplate& source = (*frame.string)[frame.at++];
    module.symbol = source.symbol;
    module.arity = static_cast<std::uint32_t>(source.parameters.size());
    module.birth = frame.birth;
    module.span = frame.rule ? frame.rule->source->span : grammar_.source->axiom->span;
    for (const ExpressionCode& code : source.parameters) {
        const std::span<const double> slots = std::span(values_).subspan(frame.slots, frame.slot_count);
        const std::optional<double> value = rewriter_.value(code, frame.rule, slots, frame.cells);
        if (!value) return false;
        values_.push_back(unrounded(*value));
    }
    return true;
}

/// Meets a module of the word after `word` steps.
bool LsysStream::meet(const Module& module, std::uint32_t word) {
    if (grammar_.has_rules(RuleKind::produce, module.symbol)) {
        const bool waits = grammar_.time(RuleKind::produce, module.symbol) != 0;
        for (; word < options_.steps; ++word) {
            const Moment moment = moment_of(word + 1, module.birth);
            const std::uint64_t draw = chooses_ ? random_.sequence(word + 1)(modules_in(word)) : 0;
            Chosen chosen;
            if (!choose_rule(RuleKind::produce, module, moment, draw, chosen)) return false;
            if (!chosen.rule && !waits) break; // a module that none fits now, none will fit later
            ++in_word_[word];
            if (modules_in(word) > options_.max_modules)
                return refuse_length(grammar_, options_.max_modules, word, diagnostics_);
            if (!chosen.rule || chosen.rule->keeps) {
                rewriter_.work(); // of the next step
                continue;
            }
            return push(chosen, module, moment, {.word = word + 1, .birth = word + 1});
        }
    }
    return count_from(word) && emit(module, 0);
}

/// Modules of the word after that step so far; without chance those that have rules.
std::uint64_t LsysStream::modules_in(std::uint32_t word) const {
    std::uint64_t count = in_word_[word];
    if (chooses_)
        for (std::size_t i = word + std::size_t{1}; i > 0; i &= i - 1)
            count += staying_[i];
    return count;
}

/// Counts a module that stays as it is from that step on.
bool LsysStream::count_from(std::uint32_t word) {
    if (++modules_ > options_.max_modules)
        return refuse_length(grammar_, options_.max_modules, options_.steps, diagnostics_);
    if (chooses_)
        for (std::size_t i = word + std::size_t{1}; i < staying_.size(); i += i & (~i + 1))
            ++staying_[i];
    return true;
}

/// Draws a module of the last word, or of what one is drawn as.
bool LsysStream::emit(const Module& module, std::uint32_t repeated) {
    if (grammar_.has_rules(RuleKind::interpret, module.symbol)) {
        Moment moment = moment_of(options_.steps, module.birth);
        moment = {moment.step + options_.share, moment.age + options_.share};
        Chosen chosen;
        const std::uint64_t draw = random_.sequence(interpreting)(interpreted_);
        if (!choose_rule(RuleKind::interpret, module, moment, draw, chosen)) return false;
        if (chosen.rule) {
            if (chosen.rule->is_random()) ++interpreted_;
            if (witness_ && repeated == 0 && !turtle_->passing_over() &&
                !witness_->begins({module.symbol, parameters(module), module.birth, true}, *turtle_))
                return false;
            if (repeated < most_interpretations) {
                return push(chosen, module, moment,
                            {.word = options_.steps,
                             .birth = module.birth,
                             .repeated = repeated + 1,
                             .interprets = true});
            }
            return refuse_endless(grammar_, RuleKind::interpret, module.symbol, chosen.rule->source->span,
                                  diagnostics_);
        }
    }
    if (!turtle_) return ++drawn_ <= options_.max_modules;
    if (!witness_ || turtle_->passing_over()) return carry_out(module);
    const bool in_word = repeated == 0;
    if (in_word && !witness_->begins({module.symbol, parameters(module), module.birth}, *turtle_))
        return false;
    witness_->runs(module.symbol, parameters(module), *turtle_);
    if (!carry_out(module)) return false;
    if (!witness_->has_run(*turtle_)) return false;
    if (in_word) witness_->ends(*turtle_);
    return true;
}

bool LsysStream::carry_out(const Module& module) {
    const TurtleCommand command = grammar_.commands[module.symbol];
    std::optional<PlacedModel> model;
    if (command == TurtleCommand::model && !turtle_->passing_over()) {
        model = models_(module.symbol, parameters(module), module.span);
        if (!model) return false;
    }
    rewriter_.work_of_drawing();
    const bool was_cut = turtle_->passing_over();
    const std::size_t polygon_work = turtle_->polygon_work();
    if (!turtle_->run(command, parameters(module), model, module.span)) return false;
    if (const std::size_t more = turtle_->polygon_work() - polygon_work; more > 0)
        rewriter_.work_of_part(more);
    if (witness_ && was_cut && !turtle_->passing_over()) witness_->closes_branch();
    return true;
}

/// Goes on with what a rule makes of the module; false after an error.
bool LsysStream::push(const Chosen& chosen, const Module& module, const Moment& moment, Frame frame) {
    const LsysRule& rule = *chosen.rule;
    frame.string = &rule.successor;
    frame.rule = &rule;
    frame.slots = static_cast<std::uint32_t>(values_.size() - module.arity);
    frame.cells = rewriter_.cells(rule.kind, moment.step);
    if (!rule.is_plain() && !(rewriter_.try_slots(rule, moment, values_, frame.slots) &&
                              rewriter_.apply_slots(rule, moment, chosen.draw, values_, frame.slots)))
        return false;
    frame.slot_count = static_cast<std::uint32_t>(values_.size() - frame.slots);
    frames_.push_back(frame);
    return true;
}

/// False after an error.
bool LsysStream::choose_rule(RuleKind kind, const Module& module, const Moment& moment, std::uint64_t draw,
                             Chosen& chosen) {
    const std::span<const double> values = parameters(module);
    if (!rewriter_.compete(kind, module.symbol, values.size(), competitors_, [&](Competitor& competitor) {
            return competitor.rule->sees_word() ? Fit::no
                                                : rewriter_.enter_values(competitor, values, moment);
        }))
        return false;
    if (competitors_.empty()) return true;
    const Winner<Competitor> winner = choose(competitors_.data(), draw);
    chosen.rule = winner.entrant->rule;
    if (chosen.rule->draws > 0) chosen.draw = winner.scattered();
    return true;
}

bool LsysStream::draw(const FoldedWord& word, Turtle& turtle) {
    turtle_ = &turtle;
    return draw(word, word.trunk());
}

/// Pieces are nested as deep as branches are.
bool LsysStream::draw(const FoldedWord& word, std::span<const ModuleId> string) {
    struct Level {
        std::span<const ModuleId> rest;
        bool is_branch;
    };
    const ModuleTable& modules = rewriter_.modules();
    std::vector<Level> levels = {{string, false}};
    while (!levels.empty()) {
        if (levels.back().rest.empty()) {
            if (levels.back().is_branch && !draw_bracket(TurtleCommand::close_branch)) return false;
            levels.pop_back();
            continue;
        }
        const ModuleId id = levels.back().rest.front();
        levels.back().rest = levels.back().rest.subspan(1);
        if (FoldedWord::is_piece(id)) {
            const bool is_branch = FoldedWord::is_branch(id);
            if (is_branch && !draw_bracket(TurtleCommand::open_branch)) return false;
            levels.push_back({word.piece(id), is_branch});
            continue;
        }
        const std::span<const double> known = modules.parameters(id);
        values_.assign(known.begin(), known.end());
        const std::uint32_t birth = modules.birth(id);
        const Module module{modules.symbol(id), static_cast<std::uint32_t>(known.size()), birth,
                            grammar_.source->axiom->span};
        ++modules_;
        rewriter_.work();
        if (!emit(module, 0) || !run()) return false;
        values_.clear();
    }
    return true;
}

bool LsysStream::draw_bracket(TurtleCommand command) {
    ++modules_;
    if (witness_ && command == TurtleCommand::open_branch) witness_->opens_branch();
    if (witness_ && command == TurtleCommand::close_branch) witness_->closes_branch();
    return turtle_->run(command, {}, std::nullopt, grammar_.source->axiom->span);
}

} // namespace graftal
