#pragma once

// One table: what every room may ask of a primitive, answered in one file each (sphere.cpp, torus.cpp, ...).
// Text and price are an engine's own, and stand in its table. All functions of a row take a primitive of the
// row's kind, and answer in the primitive's own frame.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compiler/graph/primitive.h"
#include "compiler/support/bounds.h"
#include "compiler/support/ray.h"

namespace graftal {

/// A primitive as a mesh. Closed surfaces are watertight (positions of vertices that are doubled for their
/// normals agree to the last bit) and no triangle is degenerate; corners run counter-clockwise seen from
/// outside, those of a flat primitive seen from where its normal points.
struct TessellatedPrimitive {
    std::vector<Vec3> vertices;
    std::vector<Vec3> normals; ///< one a vertex, of unit length; empty for what has flat faces only
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// The last corner of a triangle among facets.
inline constexpr std::uint32_t no_facet_corner = UINT32_MAX;
/// A facet of a flat primitive's mesh by its vertices, counter-clockwise seen from outside. Four-cornered
/// ones are cut from the first to the third corner, as the mesh is.
using FacetCorners = std::array<std::uint32_t, 4>;

/// Something whose image is bounded more tightly than that of a box.
struct HullPiece {
    enum class Kind : std::uint8_t {
        point, ///< the ball of radius `thickness` about the origin of `place`
        disc,  ///< the disc of radius 1 about the y axis at y = 0 of `place`, and what is no farther from it
    };
    Kind kind = Kind::point;
    Affine place;
    double thickness = 0; ///< in units of the primitive's frame, not of `place`
};

/// A convex body, given by its corners.
struct ConvexPart {
    std::vector<Vec3> corners;
    /// Number of corners in each of two convex rings, one after the other, or 0. The edges of one ring have
    /// the directions of the other's, or are points.
    std::size_t ring = 0;
};

/// The way in which pictures are wrapped round a primitive.
struct TextureWrap {
    bool around = false; ///< u goes round the y axis, and as many pictures as the material says
    bool along = false;  ///< v goes along the y axis: as many as keep the proportions
    bool tube = false;   ///< v goes round, too
    bool evenly = false; ///< v of a mesh has as many as u: its points are for one picture
};

/// Where a picture is wrapped round a primitive (texture_space.h).
struct TextureSpace {
    double around = 1; ///< pictures round what is round
    double along = 1;  ///< pictures along what is long
};
using TexturePoint = std::array<double, 2>; ///< u, v

/// A point of a surface, and the unit normal there.
struct SurfaceSite {
    Vec3 point{0.0};
    Vec3 normal{0, 1, 0};
};

/// Where a ray meets a primitive.
struct PrimitiveHit {
    double t = 0;
    Vec3 normal{0, 1, 0}; ///< in the primitive's frame, outwards (of the triangle: +z, of the plane: +y), of
                          ///< unit length
    std::uint64_t steps = 0; ///< among the parts of the primitive, whether or not any was met
    int facet_side =
        0; ///< of a mesh, whose normals may be smooth: 1 where the ray leaves by the facet, else -1
};

/// The range of how many numbers make a primitive of the kind; `most` is 0 for kinds without numbers.
struct PrimitiveArguments {
    std::size_t least = 0, most = 0;
};

/// One row: everything that a primitive's file tells of it. Where a primitive has no bounds, whatever needs
/// them breaks the invariant that nobody asks.
struct PrimitiveTraits {
    PrimitiveArguments arguments;
    /// Makes a primitive of finite numbers, or says what is wrong with them. Null for plain kinds, and for
    /// kinds that a file makes.
    std::optional<Primitive> (*make)(std::span<const double> numbers, std::string& fault) = nullptr;

    bool bounded = true;

    /// Exact, and the smallest ball; of shapes of many points one that is about as small (ball_about()).
    Box (*box)(const Primitive&);
    Ball (*ball)(const Primitive&);
    /// A point that is farthest along a direction, which need not be of unit length.
    Vec3 (*support_point)(const Primitive&, Vec3 direction);
    /// An upper bound of the reach along a direction, where that point takes long to find; else null.
    double (*reach)(const Primitive&, Vec3 direction) = nullptr;
    /// Things whose hull holds it.
    std::vector<HullPiece> (*hull)(const Primitive&);
    /// Convex bodies whose union is the primitive, or casts nearly its shadow.
    std::vector<ConvexPart> (*convex_parts)(const Primitive&);
    /// The radius of the largest ball or disc in it, or nearly.
    double (*inner_radius)(const Primitive&);

    /// A point that all maps leave where it is that take the primitive onto itself.
    Vec3 (*fixed_point)(const Primitive&);
    /// Whether the map takes it onto itself.
    bool (*keeps)(const Primitive&, const Affine&);

    /// The finest mesh that there is (tessellate.h).
    int max_fineness = 0;
    /// The mesh of a fineness from 0 on.
    TessellatedPrimitive (*mesh)(const Primitive&, int fineness);
    /// The largest distance between the surface and that mesh, either way; 0 if it is exact.
    double (*mesh_error)(const Primitive&, int fineness);
    /// Null: the mesh has no flat faces that are worth to be met by neighbours'.
    std::vector<FacetCorners> (*facets)(const Primitive&) = nullptr;
    /// Whether the facets close a solid, so that faces between two are not seen.
    bool solid = false;

    TextureWrap wrap;
    /// The texture point of a point of the surface.
    TexturePoint (*texture_point)(const Primitive&, const TextureSpace&, Vec3 point);
    /// The texture points of a triangle of the mesh, where points alone do not say them; else null.
    std::array<TexturePoint, 3> (*texture_triangle)(const Primitive&, const TextureSpace&,
                                                    const std::array<Vec3, 3>&) = nullptr;

    double (*area)(const Primitive&);
    /// The volume of a solid, in closed form; else null.
    double (*volume)(const Primitive&) = nullptr;
    /// The point of the surface that three numbers of [0, 1) choose; evenly spread numbers give evenly spread
    /// points.
    SurfaceSite (*site)(const Primitive&, Vec3 choice);

    /// intersect() of a ray that is sane (intersect.h).
    bool (*intersect)(const Primitive&, const Ray&, const RayRange&, PrimitiveHit&);
    /// intersect() within `most_steps`, where a ray may take many; else null.
    bool (*intersect_within)(const Primitive&, const Ray&, const RayRange&, PrimitiveHit&,
                             std::uint64_t most_steps) = nullptr;
};

#define GRAFTAL_TRAITS(name, form) extern const PrimitiveTraits name##_traits;
GRAFTAL_PRIMITIVE_KINDS(GRAFTAL_TRAITS)
#undef GRAFTAL_TRAITS

/// The rows by kind.
inline constexpr std::array<const PrimitiveTraits*, primitive_kind_count> primitive_table = {
#define GRAFTAL_ROW(name, form) &name##_traits,
    GRAFTAL_PRIMITIVE_KINDS(GRAFTAL_ROW)
#undef GRAFTAL_ROW
};

inline const PrimitiveTraits& traits_of(PrimitiveKind kind) {
    return *primitive_table[static_cast<std::size_t>(kind)];
}
inline const PrimitiveTraits& traits_of(const Primitive& primitive) {
    return traits_of(primitive.kind());
}

/// Max of <direction, x> over a bounded primitive.
double primitive_support(const Primitive& primitive, Vec3 direction);

} // namespace graftal
