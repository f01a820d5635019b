#include "compiler/lsys/walk/walk.h"

#include <algorithm>
#include <utility>

#include "compiler/lsys/derive/word.h"

namespace graftal {

namespace {

/// Most interpretations that may follow each other.
constexpr std::size_t most_walk_levels = 1000;

/// Queries are answered between the steps, and not by the turtle.
bool is_query(TurtleCommand command) {
    return command >= TurtleCommand::ask_place && command <= TurtleCommand::ask_environment;
}

} // namespace

TurtleContext turtle_context(const LsysGrammar& grammar, TurtleBodies& bodies, Diagnostics& diagnostics) {
    return {.bodies = bodies,
            .diagnostics = diagnostics,
            .angle_deg = grammar.angle_deg,
            .step = grammar.step,
            .varies_step = grammar.uses({TurtleCommand::step_by}),
            .relative_width = grammar.thickness.has_value(),
            .thinnest = grammar.thinnest,
            .varies_angle = grammar.uses({TurtleCommand::angle_by}),
            .reverses_turns = grammar.uses({TurtleCommand::reverse_turns}),
            .two_headings = grammar.uses({TurtleCommand::exchange}),
            .tropisms = grammar.tropism_kinds,
            .bending = grammar.bending};
}

TurtleState turtle_start(const LsysGrammar& grammar) {
    TurtleState start;
    start.tropism = grammar.tropism;
    start.vertical = {0, 1, 0};
    if (grammar.tropism_kinds.empty() && !grammar.uses({TurtleCommand::go_to, TurtleCommand::head_to}))
        return start;
    auto frame = std::make_shared<TurtleFrame>();
    for (std::size_t i = 0; i < grammar.other_tropisms.size(); ++i)
        frame->tropisms[i].direction = grammar.other_tropisms[i];
    start.frame = std::move(frame);
    return start;
}

LsysWalk::LsysWalk(LsysRewriter& rewriter, Diagnostics& diagnostics, CounterRandom random)
    : rewriter_(rewriter), grammar_(rewriter.grammar()), diagnostics_(diagnostics), random_(random),
      bodies_(scratch_, std::vector<Material>(1)), context_(turtle_context(grammar_, bodies_, diagnostics)) {
    context_.draws = false;
    context_.max_instances = SIZE_MAX / 2;
}

bool LsysWalk::run(std::uint32_t step, const ModuleString& word, Listener& listener) {
    turtle_ = std::make_unique<Turtle>(context_, turtle_start(grammar_));
    listener_ = &listener;
    chosen_ = 0;
    step_ = step;
    for (at_ = 0; at_ < word.size(); ++at_) {
        levels_.clear();
        const std::uint32_t birth = rewriter_.modules().birth(word[at_]);
        if (!meet(word[at_], birth, true)) return false;
        while (!levels_.empty()) {
            Level& level = levels_.back();
            if (level.next == level.string.size())
                levels_.pop_back();
            else if (!meet(level.string[level.next++], birth, false))
                return false;
        }
    }
    return true;
}

/// Goes on with what is drawn in place of the module, or carries it out.
bool LsysWalk::meet(ModuleId module, std::uint32_t birth, bool in_word) {
    rewriter_.work();
    const SymbolId symbol = rewriter_.modules().symbol(module);
    if (is_query(grammar_.commands[symbol])) return step_over(module, in_word);
    if (!grammar_.has_rules(RuleKind::interpret, symbol)) return step_over(module, in_word);
    const Moment moment = moment_of(step_, birth);
    const std::vector<Alternative>* alternatives =
        rewriter_.alternatives(RuleKind::interpret, module, moment);
    if (!alternatives) return false;
    if (alternatives->empty()) return step_over(module, in_word);
    if (levels_.size() == most_walk_levels)
        return refuse_endless(grammar_, RuleKind::interpret, symbol, alternatives->front().rule->source->span,
                              diagnostics_);
    const bool by_chance = std::ranges::any_of(
        *alternatives, [](const Alternative& alternative) { return alternative.rule->is_random(); });
    const std::uint64_t draw = by_chance ? random_.sequence(step_)(chosen_++) : 0;
    const Winner<Alternative> chosen = choose(alternatives->data(), draw);
    const ModuleString* const successor = rewriter_.successor(*chosen.entrant, module, moment, chosen.even());
    if (successor) levels_.push_back({*successor});
    return successor != nullptr;
}

bool LsysWalk::step_over(ModuleId module, bool in_word) {
    const ModuleTable& modules = rewriter_.modules();
    const TurtleCommand command = grammar_.commands[modules.symbol(module)];
    if (!is_query(command))
        return turtle_->run(command, modules.parameters(module), std::nullopt, grammar_.source->axiom->span);
    if (!turtle_->passing_over()) listener_->asks(module, at_, in_word, *turtle_);
    return true;
}

} // namespace graftal
