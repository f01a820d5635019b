#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "compiler/support/control.h"

// The angle of a drawing whose lines turn by multiples of one.

namespace graftal {

/// Turns that differ by less are equal where directions go round many times.
inline constexpr double fine_turn_deg = 0.02;

/// An angle in (-180, 180].
double wrapped_deg(double angle);

/// Means of groups of sorted values that follow each other by at most `apart`, with their numbers.
std::vector<std::pair<double, std::uint64_t>> value_groups(std::vector<double> values, double apart);

/// An angle by whose multiples all directions differ.
struct AngleGrid {
    double angle_deg = 90;
    std::int32_t directions = 4; ///< in a full circle, or 0

    /// The multiple that is nearest to a difference of directions.
    std::int32_t units(double deg) const;
    double error(double deg) const { return error_at(deg, units(deg)); }

  private:
    double error_at(double deg, std::int32_t k) const;
};

/// The angle of which the turns are the smallest multiples; nothing if there is none. `directions`: of all
/// strokes. `turns`: from strokes to those that begin where they end, by size. `follow`: finds directions
/// that go round many times by multiples of an angle; false if they are none.
std::optional<AngleGrid> find_angle(const std::vector<double>& directions, std::vector<double> turns,
                                    double noise_deg, const std::function<bool(double)>& follow,
                                    WorkMeter& meter);

} // namespace graftal
