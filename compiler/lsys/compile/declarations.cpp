#include "compiler/lsys/compile/declarations.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "compiler/lsys/compile/grammar.h"
#include "compiler/lsys/parse/commands.h"
#include "compiler/support/number.h"

namespace graftal {

namespace {

class Declarations {
  public:
    Declarations(const LsysBlock& block, Environment& lets, std::vector<double>& first_cells,
                 Diagnostics& diagnostics)
        : block_(block), lets_(lets), first_cells_(first_cells), diagnostics_(diagnostics) {}

    CellPlaces run() && {
        for (const SceneStatement& statement : block_.lets)
            for (const SceneField& let : statement.fields)
                named_.try_emplace(let.keyword, let.span);
        for (const LsysVariable& variable : block_.variables) {
            if (diagnostics_.full()) break;
            declare(variable);
        }
        for (const auto& [name, place] : places_)
            lets_.erase(name);
        note_changes();
        return std::move(places_);
    }

  private:
    void declare(const LsysVariable& variable) {
        const std::string name(variable.name.text);
        if (const auto [first, fresh] = named_.try_emplace(name, variable.name.span); !fresh) {
            diagnostics_.error(variable.name.span, fmt::format("duplicate name '{}'", name))
                .with_note(first->second, "first defined here");
            return;
        }
        if (name == "pi" || name == "step" || name == "age") {
            diagnostics_.error(variable.name.span,
                               fmt::format("'{}' has a meaning already and cannot name a variable", name));
            return;
        }
        CellPlace place;
        place.first = static_cast<std::uint32_t>(first_cells_.size());
        place.dimensions = static_cast<std::uint32_t>(std::min(variable.sizes.size(), place.sizes.size()));
        const bool good = find_sizes(variable, place);
        const std::size_t given = variable.values.size();
        if (good && given != place.count() && given > 0) {
            diagnostics_
                .error(variable.name.span,
                       fmt::format("'{}' has {} elements, but {} values", name, place.count(), given))
                .with_hint("write all values, row by row, or none for zeros");
        }
        for (const Expression& value : variable.values) {
            const std::optional<double> number = evaluate(value, lets_, diagnostics_);
            first_cells_.push_back(number.value_or(0));
        }
        first_cells_.resize(place.first + place.count(), 0.0);
        places_.emplace(name, place); // also after an error, so that nothing more is said about its name
    }

    /// If not, after an error, it has one element.
    bool find_sizes(const LsysVariable& variable, CellPlace& place) {
        const CellPlace single = place;
        if (read_sizes(variable, place)) return true;
        place = single;
        return false;
    }

    bool read_sizes(const LsysVariable& variable, CellPlace& place) {
        if (variable.sizes.size() > place.sizes.size()) {
            diagnostics_.error(variable.name.span, "an array has one or two sizes");
            return false;
        }
        std::uint64_t count = first_cells_.size();
        std::uint64_t own = 1;
        for (std::size_t i = 0; i < variable.sizes.size(); ++i) {
            const Expression& size = variable.sizes[i];
            const std::optional<double> number = evaluate(size, lets_, diagnostics_);
            if (!number) return false;
            if (!(*number >= 1 && *number <= max_cells && *number == std::floor(*number))) {
                diagnostics_.error(
                    size.span, fmt::format("the size of an array must be a whole number from 1 to {}, not {}",
                                           max_cells, shortest(*number)));
                return false;
            }
            place.sizes[i] = static_cast<std::uint32_t>(*number);
            own *= place.sizes[i];
        }
        count += own;
        if (count <= max_cells) return true;
        diagnostics_.error(
            variable.name.span,
            fmt::format("the variables of a block have more than {} numbers in all", max_cells));
        return false;
    }

    void note_changes() {
        std::set<std::string_view> targets;
        const auto note = [&](const std::optional<LsysCommands>& commands) {
            if (commands)
                for_each_assignment(commands->list,
                                    [&](const LsysCommand& command) { targets.insert(command.target); });
        };
        for (const auto* commands : {&block_.start, &block_.start_each, &block_.end_each, &block_.end})
            note(*commands);
        for (const auto* productions : {&block_.productions, &block_.decompose})
            for (const LsysProduction& production : *productions) {
                note(production.before);
                note(production.after);
            }
        for (auto& [name, place] : places_)
            place.changes = targets.contains(name);
    }

    const LsysBlock& block_;
    Environment& lets_;
    std::vector<double>& first_cells_;
    Diagnostics& diagnostics_;
    CellPlaces places_;
    std::map<std::string, Span, std::less<>> named_;
};

} // namespace

CellPlaces declare_variables(const LsysBlock& block, Environment& lets, std::vector<double>& first_cells,
                             Diagnostics& diagnostics) {
    return Declarations(block, lets, first_cells, diagnostics).run();
}

} // namespace graftal
