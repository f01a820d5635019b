#include "compiler/lsys/compile/module_table.h"

#include <algorithm>
#include <array>
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

double unrounded(double number) {
    static constexpr std::array<double, 23> powers = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                      1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                                      1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22}; // all exact
    constexpr double noise = 8e-15, digits_a_bit = 0.30102999566398120;
    constexpr double integer = 0x1.8p52; // adding and subtracting this rounds to an integer
    const int exponent = static_cast<int>(std::bit_cast<std::uint64_t>(number) >> 52 & 0x7ff) - 1023;
    const int places = 11 - static_cast<int>(std::floor(exponent * digits_a_bit));
    if (places < 0 || places >= static_cast<int>(powers.size())) return number;
    const double power = powers[static_cast<std::size_t>(places)];
    const double decimal = (number * power + integer - integer) / power;
    return std::abs(decimal - number) <= noise * std::abs(number) ? decimal : number;
}

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
    if (found == next) numbers_.push_back(unrounded(number));
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
