#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <tsl/robin_map.h>

#include "compiler/cut/cut.h"

namespace graftal {

/// Gathers primitives into one triangle mesh. A mesh without curved primitives shares vertices between
/// neighbours, draws sheets that coincide once, and leaves out the faces on which two solids meet: nobody can
/// see them.
class MeshBuilder {
  public:
    /// `smooth`: some primitive is curved, all vertices get normals.
    explicit MeshBuilder(bool smooth) : smooth_(smooth) {}

    /// Adds a primitive, meshed at the fineness, placed by a regular map. `leaf` is the caller's number.
    void add(PrimitiveKind kind, int fineness, const Affine& body_from_leaf, std::size_t leaf);

    /// Makes the triangles of the faces that are seen. Call once, after the last add().
    void finish();

    /// Hidden faces not counted.
    std::size_t triangle_count() const { return triangle_count_; }

    Mesh mesh; ///< without slots
    std::vector<std::size_t> leaf_of_triangle;

  private:
    struct GridPoint {
        std::array<std::int64_t, 3> cell;
        bool operator==(const GridPoint&) const = default;
    };
    /// A polygon of three or four corners of a flat primitive.
    struct Facet {
        static constexpr std::uint32_t no_corner = UINT32_MAX;

        std::array<std::uint32_t, 4> corners; ///< in order; a triangle's last is no_corner
        bool solid = false;
        bool hidden = false;
        std::size_t leaf = 0;
    };
    /// The corners of a facet, ascending.
    struct FacetKey {
        std::array<std::uint32_t, 4> corners;
        bool operator==(const FacetKey&) const = default;
    };
    struct Hash {
        std::size_t operator()(const GridPoint& point) const;
        std::size_t operator()(const FacetKey& key) const;
    };

    void add_smooth(PrimitiveKind kind, int fineness, const Affine& body_from_leaf, std::size_t leaf);
    void add_facets(PrimitiveKind kind, const Affine& body_from_leaf, bool mirrored, std::size_t leaf);
    void add_flat(PrimitiveKind kind, const Affine& body_from_leaf, bool mirrored, std::size_t leaf);
    std::uint32_t welded(Vec3 point);
    void add_unless_hidden(const Facet& facet);
    void push(const std::array<std::uint32_t, 3>& corners, std::size_t leaf);
    std::uint32_t used(std::uint32_t vertex);

    bool smooth_;
    std::size_t triangle_count_ = 0;
    tsl::robin_map<GridPoint, std::uint32_t, Hash> vertex_at_;
    tsl::robin_map<FacetKey, std::uint32_t, Hash> facet_at_;
    std::vector<Facet> facets_;  ///< of a flat mesh
    std::vector<Vec3> vertices_; ///< likewise, before those of hidden facets go
    std::vector<std::uint32_t> used_;
};

} // namespace graftal
