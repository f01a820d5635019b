#pragma once

#include "compiler/graph/primitive.h"
#include "compiler/support/affine.h"
#include "compiler/support/bounds.h"

namespace graftal {

/// Half of what a part measures across at least, in pixels, where it has no area by itself: a point, a curve,
/// dust, what a singular map has crushed. Programs that draw an IFS by random points fill a pixel for each.
/// Where the error allowed is less, it is that: were specks much larger than what is culled, thousands would
/// lie in each other.
inline constexpr double least_half_width_px = 0.5;

/// A map as flat as this is taken for singular: what it places is drawn as if it had no thickness of its own.
inline constexpr double flattest_leaf = 1e-6;

/// A part whose map is as flat as this is not placed but baked into a neighbour above. Rays are not taken
/// into its frame.
inline constexpr double flattest_placement = 1e-5;

/// Half of the width that a leaf is given, where it is thinner; 0 where it stays as it is. `faint`: it stands
/// for a set without area. `half_width`: least_half_width_px there, as a length; 0 where nothing is culled. A
/// sheet has an area, so that what is small is not made thicker than an eighth of its size.
double half_width_needed(const Affine& place, bool faint, double half_width);

/// The image of a primitive about the same middle, longer along its half axes where it would not hold a ball
/// of this radius. Requires another kind than plane.
Affine widened(const Primitive& primitive, const Affine& place, double radius);

/// Holds the primitive as widened() places it, for a half width that was needed.
Ball widened_ball(const Primitive& primitive, const Affine& place, double radius);

/// Half widths that a part reaches from its middle if it is widened in all directions: a ball one, the
/// corners of others more.
double widened_reach(const Primitive& primitive);

/// One place for all widened leaves of which one is enough: in one cell of half a half width, of one size to
/// a factor of 2.
Affine speck_mark(const Affine& place, double half_width);

/// A leaf as it is drawn.
struct DrawnLeaf {
    Affine place;          ///< widened() by
    double half_width = 0; ///< half_width_needed()
};

/// widened() by half_width_needed(): facts of the map that both need are found once.
DrawnLeaf drawn_leaf(const Primitive& primitive, const Affine& place, bool faint, double half_width);

} // namespace graftal
