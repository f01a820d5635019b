#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "compiler/support/affine.h"
#include "compiler/support/id_table.h"

namespace graftal {

/// A polygon of three or four corners, of a flat primitive.
struct Facet {
    static constexpr std::uint32_t no_corner = UINT32_MAX;

    std::array<std::uint32_t, 4> corners; ///< in order; a triangle's last is no_corner
    std::uint32_t leaf = 0;
    bool solid = false;  ///< of a body, counter-clockwise seen from outside
    bool hidden = false; ///< two bodies meet there

    std::size_t triangle_count() const { return corners[3] == no_corner ? 1 : 2; }
};

/// Facets over shared vertices. Of those that coincide the first is kept, and hidden if two are back to back
/// and both of bodies.
class FacetSet {
  public:
    /// The number of the vertex at this point.
    std::uint32_t vertex(Vec3 point);
    /// Corners are numbers of vertices.
    void add(const Facet& facet);
    /// Adds what is not hidden to another set, in order, and leaves this one empty. What coincides with a
    /// facet that was hidden here is kept there: nobody can see it, between two bodies.
    void move_to(FacetSet& other);

    const std::vector<Vec3>& vertices() const { return vertices_; }
    const std::vector<Facet>& facets() const { return facets_; }
    /// Number of triangles that are not hidden.
    std::size_t triangle_count() const { return triangle_count_; }

  private:
    std::vector<Vec3> vertices_;
    std::vector<Facet> facets_;
    std::size_t triangle_count_ = 0;
    IdTable vertex_ids_;
    IdTable facet_ids_;
    std::vector<std::uint32_t> moved_; ///< vertices on their way to another set: their numbers there
};

} // namespace graftal
