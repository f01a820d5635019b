#pragma once

// Parts that primitives share.

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "compiler/primitives/primitive.h"

namespace graftal {

/// `polygon(0, 0, 1, 0, 0, 1)`: the kind with its numbers, as `.inst` writes it.
std::string shape_name(PrimitiveKind kind, std::span<const double> numbers);

/// The shape of a primitive. Requires that the kind has this class of shapes.
template<typename Form> const Form& shape_of(const Primitive& primitive) {
    return static_cast<const Form&>(*primitive.shape());
}

using Triangle = std::array<Vec3, 3>;

/// Twice the area, along the normal.
Vec3 area_normal(const Triangle& triangle);

/// The point of the triangle that two numbers of [0, 1) choose evenly.
Vec3 point_of(const Triangle& triangle, double u, double v);

/// Chooses among pieces of a surface by their areas.
class AreaSampler {
  public:
    void add(double area) { sums_.push_back(whole() + area); }

    double whole() const { return sums_.empty() ? 0 : sums_.back(); }

    /// The piece that a number of [0, 1) chooses. Requires that there is one with an area.
    std::size_t piece(double share) const;

  private:
    std::vector<double> sums_; ///< of the areas up to each piece
};

/// A ball about the middle of the points' box; its radius may be a third too large.
Ball ball_about(std::span<const Vec3> points);
Box box_about(std::span<const Vec3> points);
Vec3 farthest_of(std::span<const Vec3> points, Vec3 direction);

// Columns of primitives whose mesh is exact, from that mesh and the box.
std::vector<HullPiece> hull_of_mesh(const Primitive& primitive);
std::vector<ConvexPart> triangles_of_mesh(const Primitive& primitive);
std::vector<FacetCorners> facets_of_mesh(const Primitive& primitive);
Vec3 centre_of_box(const Primitive& primitive);
double exact_mesh_error(const Primitive& primitive, int fineness);

/// Columns of these that a row may replace.
struct FlatColumns {
    decltype(PrimitiveTraits::hull) hull = hull_of_mesh;
    decltype(PrimitiveTraits::convex_parts) convex_parts = triangles_of_mesh;
    decltype(PrimitiveTraits::facets) facets = facets_of_mesh;
    decltype(PrimitiveTraits::fixed_point) fixed_point = centre_of_box;
};

/// A whole row of a primitive whose mesh is exact.
constexpr PrimitiveTraits flat_row(PrimitiveTraits own, const FlatColumns& columns = {}) {
    own.hull = columns.hull;
    own.convex_parts = columns.convex_parts;
    own.facets = columns.facets;
    own.fixed_point = columns.fixed_point;
    own.mesh_error = exact_mesh_error;
    return own;
}

} // namespace graftal
