#include "compiler/import/drawn_steps.h"

#include <array>
#include <vector>

namespace graftal {

namespace {

constexpr double most_drawn_lines = 8000;
constexpr int most_drawn_steps = 14, least_drawn_steps = 2;

using SymbolCounts = std::array<double, 256>; // by symbols

std::size_t place_of(const LSystemModule& module) {
    return static_cast<unsigned char>(module.symbol[0]);
}

void add_symbols(const LSystemString& string, double times, SymbolCounts& into) {
    for (const LSystemModule& module : string)
        into[place_of(module)] += times;
}

} // namespace

DrawnSteps steps_to_draw(const LSystem& system, std::string_view drawing) {
    const auto lines = [&](const SymbolCounts& of) {
        double sum = 0;
        for (const char symbol : drawing)
            sum += of[static_cast<unsigned char>(symbol)];
        return sum;
    };
    const std::vector<LSystemProduction>& productions = system.productions.at(LSystemSection::productions);
    SymbolCounts counts{};
    add_symbols(system.axiom, 1, counts);
    DrawnSteps drawn{0, lines(counts)};
    for (int next = 1; next <= most_drawn_steps; ++next) {
        SymbolCounts after = counts;
        for (const LSystemProduction& production : productions)
            after[place_of(production.predecessor[0])] = 0;
        for (const LSystemProduction& production : productions)
            add_symbols(production.successor, counts[place_of(production.predecessor[0])], after);
        double all = 0;
        for (const double number : after)
            all += number;
        if (next > least_drawn_steps && (lines(after) > most_drawn_lines || all > 100 * most_drawn_lines))
            break;
        counts = after;
        drawn = {next, lines(counts)};
    }
    return drawn;
}

} // namespace graftal
