#include "compiler/lsys/walk/queries.h"

#include <algorithm>
#include <utility>

namespace graftal {

namespace {

/// The random sequence of a seed that interprets for queries; those of the steps choose productions.
constexpr std::uint64_t asking = UINT64_MAX - 3;

} // namespace

LsysQueries::LsysQueries(LsysRewriter& rewriter, Diagnostics& diagnostics, std::uint64_t seed)
    : rewriter_(rewriter), grammar_(rewriter.grammar()),
      walk_(rewriter, diagnostics, CounterRandom(seed).sequence(asking)) {
    if (!grammar_.environment) return;
    EnvironmentSettings settings = *grammar_.environment;
    settings.seed = seed;
    environment_ = make_environment(settings, diagnostics);
    failed_ = !environment_;
}

bool LsysQueries::answer(std::uint32_t step, ModuleString& word) {
    met_.clear();
    failed_ = failed_ || !walk_.run(step, word, *this) || !ask_environment();
    if (failed_) return false;
    ModuleTable& modules = rewriter_.modules();
    for (const Met& met : met_)
        if (met.heard)
            word[met.at] = modules.intern(modules.symbol(met.module), met.values, modules.birth(met.module));
    return true;
}

void LsysQueries::asks(ModuleId module, std::size_t at, bool in_word, const Turtle& turtle) {
    const ModuleTable& modules = rewriter_.modules();
    const TurtleCommand command = grammar_.commands[modules.symbol(module)];
    const std::span<const double> parameters = modules.parameters(module);
    const Affine& world_from_turtle = turtle.start_from_turtle();
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
