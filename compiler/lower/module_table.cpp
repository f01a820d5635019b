#include "compiler/lower/module_table.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace graftal {

namespace {

constexpr double relative_cell = 1e-12;

/// Cells of equal relative size, of both signs: no two numbers of unlike sign share one.
std::int64_t cell_of(double number) {
    const auto cell = std::llround(std::log(std::abs(number)) / relative_cell);
    return 2 * cell + (number < 0 ? 1 : 0);
}

} // namespace

double NumberTable::representative(double number) {
    if (number == 0) return 0;
    const std::int64_t cell = cell_of(number);
    // A number near the edge of its cell may have its like next door.
    for (const std::int64_t step : {std::int64_t{0}, std::int64_t{-2}, std::int64_t{2}}) {
        const std::int64_t near = cell + step;
        const std::uint32_t found =
            ids_.find(mixed(0, static_cast<std::uint64_t>(near)), [&](std::uint32_t id) {
                return cells_[id] == near && std::abs(numbers_[id] - number) <= relative_cell * std::abs(number);
            });
        if (found != IdTable::none) return numbers_[found];
    }
    ids_.find_or_add(mixed(0, static_cast<std::uint64_t>(cell)), static_cast<std::uint32_t>(numbers_.size()),
                     [](std::uint32_t) { return false; });
    numbers_.push_back(number);
    cells_.push_back(cell);
    return number;
}

ModuleId ModuleTable::intern(SymbolId symbol, std::span<const double> parameters) {
    wanted_.clear();
    std::uint64_t hash = mixed(symbol, parameters.size());
    for (const double parameter : parameters) {
        wanted_.push_back(numbers_.representative(parameter));
        hash = mixed(hash, std::bit_cast<std::uint64_t>(wanted_.back()));
    }
    const auto next = static_cast<ModuleId>(entries_.size());
    const ModuleId id = ids_.find_or_add(hash, next, [&](ModuleId other) {
        return entries_[other].symbol == symbol && std::ranges::equal(this->parameters(other), wanted_);
    });
    if (id == next) {
        entries_.push_back({symbol, static_cast<std::uint16_t>(wanted_.size()),
                            static_cast<std::uint32_t>(parameters_.size())});
        parameters_.insert(parameters_.end(), wanted_.begin(), wanted_.end());
    }
    return id;
}

} // namespace graftal
