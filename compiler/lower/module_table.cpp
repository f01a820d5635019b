#include "compiler/lower/module_table.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace graftal {

namespace {

constexpr double slack = 1e-12;

/// Cells of numbers whose sizes differ by a ten-thousand-millionth or so, of either sign: seldom has one more
/// than a number, and seldom is one so near the edge of its cell that its like may lie next door.
std::uint64_t cell_of(double number) {
    return std::bit_cast<std::uint64_t>(number) >> 20;
}

} // namespace

double NumberTable::representative(double number) {
    if (number == 0) return 0;
    const std::uint64_t cell = cell_of(number);
    const auto like = [&](std::uint32_t id) {
        return std::abs(numbers_[id] - number) <= slack * std::abs(number);
    };
    for (const double edge : {number * (1 - slack), number * (1 + slack)}) {
        if (cell_of(edge) == cell) continue;
        const std::uint32_t found = ids_.find(mixed(0, cell_of(edge)), like);
        if (found != IdTable::none) return numbers_[found];
    }
    const auto next = static_cast<std::uint32_t>(numbers_.size());
    const std::uint32_t found = ids_.find_or_add(mixed(0, cell), next, like);
    if (found == next) numbers_.push_back(number);
    return numbers_[found];
}

ModuleId ModuleTable::intern(SymbolId symbol, std::span<const double> parameters, std::uint32_t birth) {
    wanted_.clear();
    std::uint64_t hash = mixed(symbol, parameters.size());
    if (birth != no_birth) hash = mixed(hash, birth);
    for (const double parameter : parameters) {
        wanted_.push_back(numbers_.representative(parameter));
        hash = mixed(hash, std::bit_cast<std::uint64_t>(wanted_.back()));
    }
    const auto next = static_cast<ModuleId>(entries_.size());
    const ModuleId id = ids_.find_or_add(hash, next, [&](ModuleId other) {
        return entries_[other].symbol == symbol && entries_[other].birth == birth &&
               std::ranges::equal(this->parameters(other), wanted_);
    });
    if (id == next) {
        entries_.push_back({symbol, static_cast<std::uint16_t>(wanted_.size()),
                            static_cast<std::uint32_t>(parameters_.size()), birth});
        parameters_.insert(parameters_.end(), wanted_.begin(), wanted_.end());
    }
    return id;
}

} // namespace graftal
