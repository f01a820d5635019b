#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compiler/lower/plant.h"
#include "compiler/lower/plant_sums.h"
#include "compiler/support/control.h"
#include "runtime/plants/plant_tree.h"

namespace graftal {

/// A mean over numbers that come one after the other, and their standard deviation (Welford 1962).
class RunningMean {
  public:
    void add(double value);
    std::uint64_t count() const { return count_; }
    double mean() const;      ///< no number where nothing was added
    double deviation() const; ///< of the numbers, by n - 1; no number of less than two

  private:
    std::uint64_t count_ = 0;
    double mean_ = 0, squares_ = 0;
};

/// The plant's axes of one order: 0 of the main axis, one more for each branching.
struct AxisOrder : PlantSums {
    std::uint64_t axes = 0; ///< whose first segment is of this order
    RunningMean angle_deg;  ///< between the first segment of a branch and the one that bears it
};

/// Streams of one of Strahler's orders: chains of segments of that order, as long as may be.
struct StreamOrder {
    std::uint64_t streams = 0, segments = 0;
    double length = 0;       ///< of all its segments
    double width_length = 0; ///< sum of length times mean diameter
};

/// Areas in projection along parallel rays, each organ by itself: they may hide each other. The mean over
/// directions all around, at one height.
struct Projected {
    double elevation_deg = 90;
    double leaf_area = 0, wood_area = 0;
};

/// Measures of a drawn plant, from its rows alone.
struct PlantMeasures {
    double steps = 0;
    PlantSums all;
    std::uint64_t balls = 0;
    std::uint64_t unmeasured = 0;           ///< models whose area is not known; it is in no sum
    double height = 0;                      ///< from the lowest point of an organ to the highest
    double crown_area = 0;                  ///< of the convex hull of all organs, seen from above
    std::optional<double> ground_area;      ///< that was given; else the crown's counts
    std::uint64_t tips = 0;                 ///< segments that bear none
    double longest_path = 0, mean_path = 0; ///< of segments, from the root to tips
    RunningMean angle_deg;                  ///< of all branchings
    double leaf_inclination_deg = 0;        ///< mean over leaf area, of blades' planes from the horizontal
    std::optional<double> branching_ratio;  ///< Horton's, over all orders; nothing of a single order
    std::vector<Projected> projected;       ///< from above first
    std::vector<AxisOrder> orders;
    std::vector<StreamOrder> streams;        ///< from order 1 on
    std::vector<PlantSums> ranks;            ///< by the rank of modules on their axes
    std::vector<NamedSums> names, materials; ///< as the plant has them; a model's own material has no name

    double ground() const { return ground_area.value_or(crown_area); }
};

/// Measures the plant. Throws Cancelled; charges the work. O(modules and triangles of blades).
PlantMeasures measure_plant(const Plant& plant, const PlantTree& tree, std::optional<double> ground_area,
                            const Control& control = no_control());

/// Horton's ratio by regression: e to the minus slope of the logarithms of `counts` over the order (Horton
/// 1945, "Erosional development of streams and their drainage basins"). Nothing of less than two orders.
std::optional<double> horton_ratio(const std::vector<std::uint64_t>& counts);

} // namespace graftal
