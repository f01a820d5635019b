#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compiler/support/control.h"
#include "compiler/support/flat_area.h"

namespace graftal {

/// A straight line of a drawing, in the direction in which it was drawn.
struct Stroke {
    Vec2 from{0.0}, to{0.0};
};

using Strokes = std::vector<Stroke>;

/// A way along strokes between two places.
struct StrokeWay {
    std::uint32_t to = 0;       ///< place
    std::int32_t direction = 0; ///< in angles from that of the first stroke
    std::uint32_t bundle = 0;   ///< of strokes that lie on each other
};

/// A drawing as a graph: its places, and the strokes between them by directions that are whole multiples of
/// an angle.
class StrokeGraph {
  public:
    std::vector<Vec2> places;
    std::vector<std::uint32_t> copies; ///< of each bundle
    std::vector<std::uint8_t> classes; ///< of each bundle: its length is unit * factor^class
    std::uint64_t strokes = 0;
    double unit = 1;   ///< length of the longest class
    double factor = 1; ///< from a class to the next, below 1 where there are several
    double angle_deg = 90;
    double first_deg = 0;              ///< direction 0, from the x axis
    std::int32_t directions = 0;       ///< in a full circle; 0: they never come back
    bool branches = false;             ///< no way along the strokes takes each of them once
    std::vector<std::uint32_t> starts; ///< places where the drawing may begin, the likely ones first

    std::span<const StrokeWay> ways(std::uint32_t place) const {
        return {ways_.data() + first_way_[place], ways_.data() + first_way_[place + 1]};
    }
    bool sized() const { return factor != 1; }

  private:
    friend class StrokeGraphBuilder;
    std::vector<StrokeWay> ways_;          ///< by place and direction
    std::vector<std::uint32_t> first_way_; ///< of each place
};

/// Readings of a drawing as a graph, the likely ones first; none, with the reason, if it has no angle or no
/// unit. `tolerance`: ends of strokes are one place if they are no farther apart, as a share of the shortest
/// stroke. Strokes of no length are left out. `meter`: of comparisons of strokes.
std::vector<StrokeGraph> stroke_graphs(const Strokes& strokes, double tolerance, WorkMeter& meter,
                                       std::string& problem);

} // namespace graftal
