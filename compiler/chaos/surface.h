#pragma once

#include <cstddef>
#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/graph/run.h"
#include "compiler/support/counter_random.h"

namespace graftal {

/// The matrix of cofactors: |cofactors n| is how much area with the unit normal n grows. Also of singular
/// ones.
Mat3 cofactors_of(const Mat3& a);

/// The image of a primitive under an affine map, as a set to take random points of: evenly over its
/// surface, however the map stretches it. Requires a primitive that is bounded: no plane.
class PlacedSurface {
  public:
    PlacedSurface(const Primitive& primitive, const Affine& world_from_primitive);

    /// The area of the image, to some per cent; exact of what lies in a plane, and under similarities.
    double area() const { return area_; }
    /// A point of the image.
    Vec3 point(RandomStream& random) const;

  private:
    friend struct FlatGame;

    Primitive primitive_;
    Affine map_;
    Mat3 cofactors_;     ///< turn a normal into the image's, as long as area grows there
    double most_growth_; ///< of area, anywhere on the surface
    double area_;
};

/// The areas of what an item draws: its body, and the ball at its far end; exact.
struct ItemAreas {
    double body = 0, ball = 0;
};
ItemAreas areas_of(const RunItem& item);
/// Their sums, of the items of packed edges.
std::vector<double> areas_of_items(const PackedEdges& edges);
/// A point of one of them, evenly spread.
Vec3 point_of_item(const PackedEdges& edges, std::size_t number, RandomStream& random);

} // namespace graftal
