#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace graftal {

/// Number of drawn segments by length: lengths to the quarter of an octave, counts as logarithms, since they
/// go beyond doubles.
class LengthTally {
  public:
    /// Requires a positive length.
    void add(double length);
    /// All segments of another, this many times as long.
    void add(const LengthTally& other, double scale);

    bool empty() const { return bins_.empty(); }
    /// Requires some segments, as does median().
    double longest() const { return bins_.back().longest; }
    /// The length up to which segments make up half of the length of all.
    double median() const;

  private:
    struct Bin {
        int quarter = 0;         ///< of an octave, that the lengths lie in
        double longest = 0;      ///< of them
        std::uint64_t count = 0; ///< of those that came one by one
        double log_more = -1e9;  ///< natural, of the number of the others; so little is none

        double log_count() const;
    };

    std::size_t place_of(int quarter);

    std::vector<Bin> bins_; ///< from short to long
    std::size_t last_ = 0;  ///< where a length was found last
};

} // namespace graftal
