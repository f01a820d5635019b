#pragma once

// Scenes for renderers with one level of instances: a list of meshes, and where they lie.

#include "compiler/unfolded/looks.h"
#include "runtime/export/formats/group_mesh.h"
#include "runtime/export/formats/picture_copies.h"

namespace graftal {

/// A material in a colour.
struct RendererLook {
    std::optional<MaterialId> material;
    Rgb colour{0.8}; ///< linear
    bool pictured = false;
};

class RendererScene {
  public:
    /// Nothing, after an error, for what is too large. `bytes_of_triangle`, `bytes_of_place`: in the file.
    static std::optional<RendererScene> make(const ExportJob& job, double bytes_of_triangle,
                                             double bytes_of_place);

    const UnfoldedScene& scene() const { return scene_; }
    const MeshGroups& groups() const { return groups_; }
    const std::vector<MeshPlace>& places() const { return places_; }
    const std::vector<RendererLook>& looks() const { return looks_; }

    /// The surfaces of a mesh, each in one look.
    std::vector<GroupSurface> surfaces(SceneId mesh, ShapeMeshes& meshes) const;
    std::size_t look_of(const GroupSurface& surface) const;
    /// "12 meshes of 3400 triangles, 56 instances"
    std::string summary() const;

  private:
    UnfoldedScene scene_;
    MeshGroups groups_;
    std::vector<MeshPlace> places_;
    std::vector<RendererLook> looks_;
    std::map<std::pair<std::int64_t, std::array<std::uint8_t, 3>>, std::size_t> number_of_;
};

/// Half the angle of view along the shorter side, times two.
double shorter_angle_deg(const View& view);

/// Units of light of a lamp that is as bright at the model as POV-Ray's, which do not fade.
double lamp_at_model(const UnfoldedScene& scene, const Light& light);

} // namespace graftal
