#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "compiler/detail/mesh/facet_set.h"
#include "compiler/detail/mesh/limit_normal.h"
#include "compiler/detail/mesh/mesh.h"
#include "compiler/primitives/texture_space.h"

namespace graftal {

/// Gathers primitives into one triangle mesh. A mesh without curved primitives shares vertices between
/// neighbours, draws sheets that coincide once, and leaves out the faces on which two solids meet: nobody can
/// see them.
class MeshBuilder {
  public:
    /// `smooth`: some primitive is curved, all vertices get normals.
    explicit MeshBuilder(bool smooth) : smooth_(smooth) {}

    /// Leaves out triangles whose outer side faces this way, from now on: a sheet has one face then. Zero:
    /// none.
    void leave_out(Vec3 facing) { left_out_ = facing; }
    /// Adds a primitive, meshed at the fineness, placed by a regular map. `leaf` is the caller's number.
    /// What is curved has its own normals, with the field's added to them.
    void add(const Primitive& primitive, int fineness, const Affine& body_from_leaf, std::uint32_t leaf,
             const NormalField& normals = {});

    /// Adds a primitive to a smooth mesh, with texture coordinates; each triangle has corners of its own.
    void add_textured(const Primitive& primitive, int fineness, const Affine& body_from_leaf,
                      const TextureSpace& space, std::uint32_t leaf);

    /// Makes the triangles of the faces that are seen. Call once, after the last add().
    void finish();

    /// Triangles so far, without faces that are found to be hidden.
    std::size_t triangle_count() const;

    Mesh mesh; ///< without slots
    std::vector<std::uint32_t> leaf_of_triangle;

  private:
    void add_smooth(const Primitive& primitive, int fineness, const Affine& body_from_leaf,
                    std::uint32_t leaf, const NormalField& normals);
    void add_facets(const Primitive& primitive, const Affine& body_from_leaf, bool mirrored,
                    std::uint32_t leaf);
    void add_flat(const Primitive& primitive, const Affine& body_from_leaf, bool mirrored,
                  std::uint32_t leaf);
    bool leaves_out(Vec3 a, Vec3 b, Vec3 c, bool mirrored) const;
    void push(const std::array<std::uint32_t, 3>& corners, std::uint32_t leaf);
    std::uint32_t used(std::uint32_t vertex);

    bool smooth_;
    Vec3 left_out_{0.0};
    // Facets of a flat mesh. Neighbours come soon after each other: most faces meet while they are among the
    // latest few, whose tables are small enough for a cache.
    FacetSet latest_;
    FacetSet all_;
    std::vector<std::uint32_t> used_;
    std::vector<std::uint32_t> index_; ///< of a primitive's vertices; kept for its memory
};

} // namespace graftal
