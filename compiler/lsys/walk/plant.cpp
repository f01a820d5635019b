#include "compiler/lsys/walk/plant.h"

#include <unordered_map>
#include <utility>

#include "compiler/lsys/walk/walk.h"

namespace graftal {

namespace {

/// The random sequence that chooses interpretations here.
constexpr std::uint64_t growing = UINT64_MAX - 4;

bool is_part(TurtleCommand command) {
    switch (command) {
    case TurtleCommand::none:
    case TurtleCommand::draw:
    case TurtleCommand::draw_always:
    case TurtleCommand::draw_unrecorded:
    case TurtleCommand::sphere:
    case TurtleCommand::disc:
    case TurtleCommand::model:
        return true;
    default:
        return false;
    }
}

/// Takes the modules of a word as the turtle comes to them.
class PlantBuilder : private LsysWalk::Listener {
  public:
    PlantBuilder(const DerivedWord& derived)
        : derived_(derived), grammar_(derived.rewriter.grammar()), modules_(derived.rewriter.modules()) {}

    std::optional<Plant> run(std::uint64_t seed, Diagnostics& diagnostics) {
        LsysWalk walk(derived_.rewriter, diagnostics, CounterRandom(seed).sequence(growing));
        plant_.steps = derived_.steps;
        if (!walk.run(derived_.steps, derived_.word, grammar_.width.value_or(0), *this)) return std::nullopt;
        return std::move(plant_);
    }

  private:
    /// The axis that the turtle is on.
    struct Axis {
        std::uint32_t last = PlantModule::none; ///< module on it, or the one that it leaves
        bool begins = false;                    ///< nothing stands on it yet
        std::uint32_t order = 0, next_rank = 0;
    };

    void begins(std::size_t at, const Turtle& turtle) override {
        const ModuleId id = derived_.word[at];
        const SymbolId symbol = modules_.symbol(id);
        const TurtleCommand command = grammar_.commands[symbol];
        taken_ = false;
        if (command == TurtleCommand::open_branch) {
            axes_.push_back(axis_);
            // A branch that begins where another has just begun leaves the same module.
            const bool leaves = axis_.last != PlantModule::none && !axis_.begins;
            axis_ = {axis_.last, true, axis_.order + (leaves ? 1 : 0), 0};
        } else if (command == TurtleCommand::close_branch && !axes_.empty()) {
            axis_ = axes_.back();
            axes_.pop_back();
        }
        if (!is_part(command) || turtle.passing_over()) return;
        taken_ = true;
        PlantModule module;
        module.name = name_of(symbol);
        const std::span<const double> parameters = modules_.parameters(id);
        module.parameters.assign(parameters.begin(), parameters.end());
        module.parent = axis_.last;
        module.branches = axis_.begins && axis_.last != PlantModule::none;
        module.order = axis_.order;
        module.rank = axis_.next_rank++;
        module.start = turtle.start_from_turtle().translation;
        module.heading = turtle.start_from_turtle().linear[1];
        if (const std::uint32_t birth = modules_.birth(id); birth != ModuleTable::no_birth)
            module.age = static_cast<std::int64_t>(derived_.steps) - birth;
        axis_.last = static_cast<std::uint32_t>(plant_.modules.size());
        axis_.begins = false;
        plant_.modules.push_back(std::move(module));
    }

    void ends(std::size_t, const Turtle& turtle) override {
        if (!taken_) return;
        PlantModule& module = plant_.modules.back();
        module.end = turtle.start_from_turtle().translation;
        module.width = turtle.state().width;
    }

    std::uint16_t name_of(SymbolId symbol) {
        const auto [known, fresh] =
            names_.try_emplace(symbol, static_cast<std::uint16_t>(plant_.names.size()));
        if (fresh) plant_.names.push_back(grammar_.symbols[symbol]);
        return known->second;
    }

    const DerivedWord& derived_;
    const LsysGrammar& grammar_;
    const ModuleTable& modules_;
    Plant plant_;
    std::unordered_map<SymbolId, std::uint16_t> names_;
    Axis axis_;
    std::vector<Axis> axes_; ///< of the branches under way
    bool taken_ = false;
};

} // namespace

std::optional<Plant> plant_of(const DerivedWord& derived, std::uint64_t seed, Diagnostics& diagnostics) {
    return PlantBuilder(derived).run(seed, diagnostics);
}

} // namespace graftal
