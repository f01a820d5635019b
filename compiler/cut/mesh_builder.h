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

    /// Drops hidden faces and unused vertices. Call once, after the last add().
    void finish();

    std::size_t triangle_count() const { return mesh.triangles.size(); }

    Mesh mesh; ///< without slots
    std::vector<std::size_t> leaf_of_triangle;

  private:
    struct GridPoint {
        std::array<std::int64_t, 3> cell;
        bool operator==(const GridPoint&) const = default;
    };
    struct Face {
        std::array<std::uint32_t, 3> corners; ///< ascending
        bool operator==(const Face&) const = default;
    };
    struct Hash {
        std::size_t operator()(const GridPoint& point) const;
        std::size_t operator()(const Face& face) const;
    };
    struct Origin {
        bool solid = false;
        bool hidden = false;
    };

    void add_smooth(PrimitiveKind kind, int fineness, const Affine& body_from_leaf, std::size_t leaf);
    void add_facets(PrimitiveKind kind, const Affine& body_from_leaf, bool mirrored, std::size_t leaf);
    void add_flat(PrimitiveKind kind, const Affine& body_from_leaf, bool mirrored, std::size_t leaf);
    std::uint32_t welded(Vec3 point);
    void push_unless_hidden(std::array<std::uint32_t, 3> corners, bool solid, std::size_t leaf);
    void push(std::array<std::uint32_t, 3> corners, std::size_t leaf);
    void drop_unused_vertices();

    bool smooth_;
    tsl::robin_map<GridPoint, std::uint32_t, Hash> vertex_at_;
    tsl::robin_map<Face, std::uint32_t, Hash> triangle_at_;
    std::vector<Origin> origin_; ///< by triangle of a flat mesh
};

} // namespace graftal
