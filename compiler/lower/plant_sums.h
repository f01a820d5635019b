#pragma once

#include <string>
#include <vector>

#include "compiler/support/big_count.h"

namespace graftal {

/// Sums over organs, in units of the model. Wood is segments, leaves are blades (is_blade()).
struct PlantSums {
    BigCount modules = 0;  ///< of the word
    BigCount segments = 0; ///< with a length
    BigCount leaves = 0;
    double length = 0;                     ///< of segments
    double wood_area = 0, wood_volume = 0; ///< of segments, without their ends
    double leaf_area = 0;                  ///< one side

    PlantSums& operator+=(const PlantSums& other) { return add(other, 1); }
    /// Adds those of organs that are so many times as large here.
    PlantSums& add(const PlantSums& other, double scale);
    bool empty() const { return modules == 0 && segments == 0 && leaves == 0; }
};

struct NamedSums : PlantSums {
    std::string name;
};

/// Sums over a plant of any number of modules.
struct PlantTotals {
    double steps = 0; ///< of the derivation
    PlantSums all;
    BigCount balls = 0;
    BigCount unmeasured = 0;                 ///< models whose area is not known; it is in no sum
    std::vector<PlantSums> orders;           ///< by the order of axes: 0 of the main one
    std::vector<NamedSums> names, materials; ///< a model's own material has no name
};

} // namespace graftal
