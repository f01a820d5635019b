#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "compiler/support/affine.h"
#include "compiler/support/flat_area.h"

namespace graftal {

/// A grid of cells of the plane or of space, each one unit wide, from the origin on.
template<typename Point> class CellLattice {
  public:
    static constexpr std::size_t dimensions = Point::length();
    using Place = std::array<std::uint16_t, dimensions>; ///< a cell

    explicit CellLattice(const std::array<std::size_t, dimensions>& sides) : sides_(sides) {
        for (std::size_t k = 0; k < dimensions; ++k) {
            ends_[k] = static_cast<double>(sides[k]);
            cells_ *= sides[k];
        }
    }

    std::size_t side(std::size_t axis) const { return sides_[axis]; }
    std::size_t cells() const { return cells_; }
    bool holds(Point p) const {
        for (std::size_t k = 0; k < dimensions; ++k)
            if (!(p[at(k)] >= 0 && p[at(k)] < ends_[k])) return false;
        return true;
    }
    /// The cell with this point. Requires holds(p).
    std::size_t index(Point p) const {
        std::size_t cell = 0;
        for (std::size_t k = dimensions; k-- > 0;)
            cell = cell * sides_[k] + static_cast<std::size_t>(static_cast<std::uint32_t>(p[at(k)]));
        return cell;
    }
    /// The cell with this point; a point outside counts as one of the border.
    std::size_t clamped_index(Point p) const {
        std::size_t cell = 0;
        for (std::size_t k = dimensions; k-- > 0;) {
            const double x = p[at(k)];
            const std::size_t there = x < 0              ? 0
                                      : x < ends_[k] - 1 ? static_cast<std::size_t>(static_cast<int>(x))
                                                         : sides_[k] - 1;
            cell = cell * sides_[k] + there;
        }
        return cell;
    }
    Place place(std::size_t cell) const {
        Place place;
        for (std::size_t k = 0; k < dimensions; ++k, cell /= sides_[k - 1])
            place[k] = static_cast<std::uint16_t>(cell % sides_[k]);
        return place;
    }
    static Point middle(const Place& place) {
        Point p;
        for (std::size_t k = 0; k < dimensions; ++k)
            p[at(k)] = place[k] + 0.5;
        return p;
    }
    /// The steps from a cell to itself and to its neighbours, those at its corners, too.
    std::vector<std::ptrdiff_t> neighbours() const {
        std::vector<std::ptrdiff_t> steps(1, 0);
        std::ptrdiff_t stride = 1;
        for (std::size_t k = 0; k < dimensions; stride *= static_cast<std::ptrdiff_t>(sides_[k++]))
            for (std::size_t i = 0, count = steps.size(); i < count; ++i)
                steps.insert(steps.end(), {steps[i] - stride, steps[i] + stride});
        return steps;
    }

  private:
    static constexpr int at(std::size_t axis) { return static_cast<int>(axis); }

    std::array<std::size_t, dimensions> sides_;
    std::array<double, dimensions> ends_{};
    std::size_t cells_ = 1;
};

} // namespace graftal
