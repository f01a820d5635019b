#pragma once

#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "compiler/support/affine.h"

namespace graftal {

/// Directions by chance, more of them where a picture of the sky is bright. In longitude and latitude their
/// density runs linearly between the middles of texels, as the light does. A table of rows and one of each
/// row's columns give a texel (Pharr, Jakob and Humphreys, "Physically Based Rendering", 3rd ed., 14.2.4); a
/// tent gives the way from its middle. Only light above the mean counts, since another strategy finds the
/// rest as well: Karlik, Sik, Vevoda, Skrivan and Krivanek, "MIS Compensation" (2019).
class SkySampling {
  public:
    /// `light` of texels, row by row, the top first. Requires that each is finite and not negative.
    SkySampling(int width, int height, std::span<const float> light);

    /// Whether any light is above the mean; else no direction has a density.
    bool any() const { return any_; }

    /// The direction that two numbers in [0, 1) choose. Requires any().
    Vec3 direction(glm::dvec2 place) const;
    /// The density of direction(), per steradian. Requires a unit vector.
    double density(Vec3 direction) const;

    /// The tables, for engines that read them by themselves: the chance of each row or one before it; and
    /// likewise of each column within its row, row by row.
    std::span<const double> rows() const { return rows_; }
    std::span<const float> columns() const { return columns_; }

  private:
    double row_chance(std::size_t row) const { return row > 0 ? rows_[row] - rows_[row - 1] : rows_[0]; }
    /// The chance of a column as it is rounded, so that sampling and its density agree.
    double column_chance(std::size_t row, std::size_t column) const {
        const float* const chances = columns_.data() + row * width_;
        return column > 0 ? chances[column] - chances[column - 1] : chances[0];
    }

    std::size_t width_, height_;
    bool any_ = false;
    std::vector<double> rows_;   ///< the chance of this row or one before
    std::vector<float> columns_; ///< likewise within a row
};

} // namespace graftal
