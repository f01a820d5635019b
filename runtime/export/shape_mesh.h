#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "compiler/unfolded/scene.h"

namespace graftal {

/// A shape as files have it: each vertex with its normal, and with its place on a picture where it has one. A
/// corner between flat faces is there once for each face, and one on the seam of a picture once for each
/// side.
struct ShapeMesh {
    std::vector<Vec3> vertices;
    std::vector<Vec3> normals;                           ///< one a vertex, of unit length
    std::vector<std::array<double, 2>> uv;               ///< empty, or one a vertex
    std::vector<std::array<std::uint32_t, 3>> triangles; ///< counter-clockwise seen from outside
};

/// The meshes that have places on a picture.
enum class PicturePlaces {
    of_pictures, ///< those whose material has a picture
    of_surfaces, ///< and those whose surface has texture points of its own, so that it may get one later
};

/// The meshes of shapes, each made when it is first asked for.
class ShapeMeshes {
  public:
    explicit ShapeMeshes(const UnfoldedScene& scene, PicturePlaces places = PicturePlaces::of_pictures)
        : scene_(scene), places_(places) {}

    /// The mesh that the look shows, with its places on a picture if it has them.
    const ShapeMesh& of(std::uint32_t shape, const SceneLook& look);

  private:
    bool has_places(const Primitive& primitive, const SceneLook& look) const;

    struct Key {
        std::uint32_t shape = 0;
        double around = 0, along = 0; ///< 0: no places on a picture
        auto operator<=>(const Key&) const = default;
    };

    const UnfoldedScene& scene_;
    PicturePlaces places_;
    std::map<Key, ShapeMesh> known_;
};

/// A mesh at its place: corners still run counter-clockwise seen from outside.
struct PlacedShape {
    PlacedShape(const ShapeMesh& mesh, const Affine& place);

    Vec3 vertex(std::size_t i) const { return place(mesh->vertices[i]); }
    Vec3 normal(std::size_t i) const;
    std::array<std::uint32_t, 3> triangle(std::size_t i) const {
        const auto& t = mesh->triangles[i];
        return mirrored ? std::array{t[0], t[2], t[1]} : t;
    }

    const ShapeMesh* mesh;
    Affine place;
    Mat3 normal_by_normal;
    bool mirrored;
};

} // namespace graftal
