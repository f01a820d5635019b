#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace graftal {

/// Where a number, or an array of one or two indices, lies in a row of cells.
struct CellPlace {
    std::uint32_t first = 0;
    std::uint32_t dimensions = 0; ///< 0: a number
    std::array<std::uint32_t, 2> sizes = {1, 1};
    bool changes = true; ///< some statement writes it

    std::uint32_t count() const { return sizes[0] * sizes[1]; }
};

/// Named cells: the variables of a model.
using CellPlaces = std::map<std::string, CellPlace, std::less<>>;

/// The cells that an expression sees.
struct ExpressionCells {
    const CellPlaces* places = nullptr; ///< null: there are none
    std::span<const double> values;

    /// Null if no cell has the name.
    const CellPlace* find(std::string_view name) const {
        if (!places) return nullptr;
        const auto found = places->find(name);
        return found == places->end() ? nullptr : &found->second;
    }
};

/// The whole number that an index stands for: its fraction is dropped, except where it is rounding only.
/// Nothing if it is not one of [0, size).
std::optional<std::uint32_t> cell_index(double index, std::uint32_t size);

} // namespace graftal
