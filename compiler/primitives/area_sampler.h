#pragma once

#include <cstddef>
#include <vector>

namespace graftal {

/// Chooses among pieces of a surface by their areas.
class AreaSampler {
  public:
    void add(double area) { sums_.push_back(whole() + area); }

    double whole() const { return sums_.empty() ? 0 : sums_.back(); }

    /// The piece that a number of [0, 1) chooses. Requires that there is one with an area.
    std::size_t piece(double share) const;

  private:
    std::vector<double> sums_; ///< of the areas up to each piece
};

} // namespace graftal
