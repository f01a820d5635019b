#include "compiler/lsys/derive/queries.h"

#include <algorithm>
#include <utility>

#include "compiler/lsys/derive/word.h"

namespace graftal {

namespace {

/// The random sequence of a seed that interprets for queries; those of the steps choose productions.
constexpr std::uint64_t asking = UINT64_MAX - 3;
/// Most interpretations that may follow each other.
constexpr std::size_t most_query_levels = 1000;

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

LsysQueries::LsysQueries(LsysRewriter& rewriter, Diagnostics& diagnostics, std::uint64_t seed)
    : rewriter_(rewriter), grammar_(rewriter.grammar()), diagnostics_(diagnostics),
      random_(CounterRandom(seed).sequence(asking)), bodies_(scratch_, std::vector<Material>(1)),
      context_(turtle_context(grammar_, bodies_, diagnostics)) {
    context_.draws = false;
    context_.max_instances = SIZE_MAX / 2;
    if (!grammar_.environment) return;
    EnvironmentSettings settings = *grammar_.environment;
    settings.seed = seed;
    environment_ = make_environment(settings, diagnostics);
    failed_ = !environment_;
}

bool LsysQueries::answer(std::uint32_t step, ModuleString& word) {
    met_.clear();
    failed_ = failed_ || !walk(step, word) || !ask_environment();
    if (failed_) return false;
    ModuleTable& modules = rewriter_.modules();
    for (const Met& met : met_)
        if (met.heard)
            word[met.at] = modules.intern(modules.symbol(met.module), met.values, modules.birth(met.module));
    return true;
}

bool LsysQueries::walk(std::uint32_t step, const ModuleString& word) {
    turtle_ = std::make_unique<Turtle>(context_, turtle_start(grammar_));
    chosen_ = 0;
    for (std::size_t at = 0; at < word.size(); ++at) {
        levels_.clear();
        const std::uint32_t birth = rewriter_.modules().birth(word[at]);
        if (!meet(step, word[at], birth, at, true)) return false;
        while (!levels_.empty()) {
            Level& level = levels_.back();
            if (level.next == level.string.size())
                levels_.pop_back();
            else if (!meet(step, level.string[level.next++], birth, at, false))
                return false;
        }
    }
    return true;
}

/// Goes on with what is drawn in place of the module, or carries it out.
bool LsysQueries::meet(std::uint32_t step, ModuleId module, std::uint32_t birth, std::size_t at,
                       bool in_word) {
    rewriter_.work();
    const SymbolId symbol = rewriter_.modules().symbol(module);
    if (is_query(grammar_.commands[symbol])) return step_over(module, at, in_word);
    if (!grammar_.has_rules(RuleKind::interpret, symbol)) return step_over(module, at, in_word);
    const Moment moment = moment_of(step, birth);
    const std::vector<Alternative>* alternatives =
        rewriter_.alternatives(RuleKind::interpret, module, moment);
    if (!alternatives) return false;
    if (alternatives->empty()) return step_over(module, at, in_word);
    if (levels_.size() == most_query_levels)
        return refuse_endless(grammar_, RuleKind::interpret, symbol, alternatives->front().rule->source->span,
                              diagnostics_);
    const bool by_chance = std::ranges::any_of(
        *alternatives, [](const Alternative& alternative) { return alternative.rule->is_random(); });
    const std::uint64_t draw = by_chance ? random_.sequence(step)(chosen_++) : 0;
    const Winner<Alternative> chosen = choose(alternatives->data(), draw);
    const ModuleString* const successor =
        rewriter_.successor(*chosen.entrant, module, moment, chosen.even_set());
    if (successor) levels_.push_back({*successor});
    return successor != nullptr;
}

bool LsysQueries::step_over(ModuleId module, std::size_t at, bool in_word) {
    const ModuleTable& modules = rewriter_.modules();
    const TurtleCommand command = grammar_.commands[modules.symbol(module)];
    const std::span<const double> parameters = modules.parameters(module);
    if (!is_query(command))
        return turtle_->run(command, parameters, std::nullopt, grammar_.source->axiom->span);
    if (turtle_->passing_over()) return true;
    const Affine& world_from_turtle = turtle_->start_from_turtle();
    Met met{at, in_word, module, world_from_turtle.translation, {parameters.begin(), parameters.end()}};
    const auto tell = [&](Vec3 what) {
        for (std::size_t i = 0; i < std::min<std::size_t>(3, met.values.size()); ++i)
            met.values[i] = what[static_cast<int>(i)];
    };
    if (command == TurtleCommand::ask_place) tell(met.place);
    if (command == TurtleCommand::ask_heading) tell(world_from_turtle.linear[1]);
    if (command == TurtleCommand::ask_up) tell(world_from_turtle.linear[2]);
    if (command == TurtleCommand::ask_left) tell(-world_from_turtle.linear[0]);
    if (in_word || command == TurtleCommand::ask_environment) met_.push_back(std::move(met));
    return true;
}

/// All queries of the environment at once.
bool LsysQueries::ask_environment() {
    if (!environment_) return true;
    std::vector<EnvironmentQuery> queries;
    for (Met& met : met_)
        if (grammar_.commands[rewriter_.modules().symbol(met.module)] == TurtleCommand::ask_environment)
            queries.push_back({met.place, met.values});
    return environment_->answer(queries);
}

} // namespace graftal
