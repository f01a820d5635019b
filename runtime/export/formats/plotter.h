#pragma once

#include <vector>

#include "runtime/export/formats/plane_view.h"

namespace graftal {

/// A line that a pen draws without being lifted.
using PenStroke = std::vector<Point2>;

/// Puts strokes that go on from each other together, and drops those that are drawn already. Orders and
/// turns the rest: a lifted pen goes to the nearest end that is left. `tolerance`: ends that are no farther
/// apart are one. Takes about n log n steps for n strokes, however they are spread.
std::vector<PenStroke> pen_path(std::vector<PenStroke> strokes, double tolerance);

/// Length of the pen's way while it is lifted, from the first stroke on.
double lifted_length(const std::vector<PenStroke>& strokes);

} // namespace graftal
