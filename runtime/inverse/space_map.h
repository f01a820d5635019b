#pragma once

#include "compiler/support/affine.h"
#include "runtime/inverse/plane_map.h"

namespace graftal {

/// A map of space: a row of `codes 3d`. It offers the search the same as PlaneMap.
struct SpaceMap : Affine {
    using Point = Vec3;
    static constexpr std::size_t dimensions = 3;
    static constexpr std::size_t entries = 12;
    static constexpr std::size_t similar_entries = 7;

    double determinant() const;
    Vec3 transposed(Vec3 p) const { return p * linear; }
    SpaceMap taking(Vec3 from, Vec3 to) const { return {{linear, to - linear * from}}; }
    /// A determinant nearer to 0 counts as 1e-10.
    std::array<double, entries> log_slope() const;
    std::array<std::array<double, entries>, similar_entries> similar_steps() const;
    static SpaceMap half() { return {{Mat3(0.5), Vec3(0.0)}}; }
    static SpaceMap random(bool missed, bool similar, Draws& draws);
};

using SpaceMaps = std::vector<SpaceMap>;

double largest_stretch(const SpaceMaps& maps);

/// Moves the map by `step`: for each coordinate of the image, the changes of its row of the linear part, and
/// of that coordinate at `centre`. Where it then lengthens more than `most`, its stretches are cut to that.
SpaceMap moved(const SpaceMap& map, const double* step, Vec3 centre, double most);

SpaceMap nearest_similarity(const SpaceMap& map, Vec3 centre);
SpaceMap bounded_inverse(const SpaceMap& map, Vec3 centre, double least);
Vec3 fixed_point(const SpaceMap& map);

} // namespace graftal
