#include "compiler/lower/plant_sums.h"

namespace graftal {

PlantSums& PlantSums::add(const PlantSums& other, double scale) {
    const double square = scale * scale;
    modules += other.modules;
    segments += other.segments;
    leaves += other.leaves;
    length += scale * other.length;
    wood_area += square * other.wood_area;
    wood_volume += square * scale * other.wood_volume;
    leaf_area += square * other.leaf_area;
    return *this;
}

} // namespace graftal
