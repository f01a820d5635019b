#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace graftal {

/// A value that takes several values, one after the other.
struct SweepAxis {
    std::string name;                ///< seed, steps, or that of a `let`
    std::vector<std::string> values; ///< texts for the command line

    /// The option that sets it to a value, such as {"--set", "k=0.5"}.
    std::vector<std::string> words(const std::string& value) const;
    bool operator==(const SweepAxis&) const = default;
};

/// "seed=1..100", "k=0..1 by 0.05" (from the first value in steps until the second, which counts if a step
/// meets it) or "k=0,0.3,1". Nothing if it is malformed, or has more than most_tasks values.
std::optional<SweepAxis> parse_sweep_axis(std::string_view text);

/// Number of combinations of the values; more than most_tasks where there are more.
std::uint64_t point_count(const std::vector<SweepAxis>& axes);

/// The value of each axis at the point of this number, from 0 on: the last axis runs fastest.
std::vector<std::string> values_at(const std::vector<SweepAxis>& axes, std::uint64_t point);

/// The values at a point as text: "k=0.5 seed=3".
std::string label_at(const std::vector<SweepAxis>& axes, std::uint64_t point);

/// Columns of a table that shows all points. The last axis of several has a row for itself. One alone is
/// broken into rows so that there are about as many as columns.
std::uint64_t column_count(const std::vector<SweepAxis>& axes);

} // namespace graftal
