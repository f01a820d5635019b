#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "compiler/povray/cut_parts.h"
#include "compiler/povray/emit/names.h"
#include "compiler/povray/emit/patterns.h"
#include "compiler/povray/output.h"
#include "compiler/support/id_table.h"

namespace graftal {

/// Gathers the looks of a cut's groups: textures, and the finishes and palettes that these share. Tints are
/// applied exactly (Hart 1992, eq. (9) and (10)): to a single colour here, over a palette by a second layer
/// of the texture.
class PovrayTextures {
  public:
    /// `prefix` begins every name; `file_stem` the names of pictures. `by_material`: looks of different
    /// materials are different though they are equal.
    PovrayTextures(const Cut& cut, const PovrayUnits& units, const std::string& prefix, std::string file_stem,
                   bool by_material);

    /// Texture of the group's primitives and meshes: an index into all(). Equal looks have equal indices.
    std::uint32_t texture_of(const PlacementGroup& group);
    /// A texture of one colour.
    std::string plain(Rgb rgb, const Material& material);
    /// The texture of the ground: a picture lies on it as texture_space.h says. `pov_from_picture` places
    /// the picture, the unit square of x and y.
    std::string ground(const Material& material, const Affine& pov_from_picture);

    /// `texture { ... }`, one or two layers.
    const std::deque<std::string>& all() const { return textures_; }
    /// `#ifndef (Prefix_T_wood) #declare Prefix_T_wood = ... #end` for each material, so that who includes
    /// the file can declare it before. Where tints and palettes make several textures of one material, all of
    /// them are its texture then. Gives what stands in place of all(), in the same order.
    struct Overridable {
        std::string declarations;
        std::vector<std::string> names;     ///< by texture
        std::vector<std::string> materials; ///< the names that can be declared
    };
    Overridable overridable() const;
    /// The least share that a tint leaves of the palette below it; 1 if there are no layers.
    double least_transmit() const { return least_transmit_; }
    /// `#declare` of the finishes and palettes that the textures name. Adds the pictures they need.
    std::string declarations(std::vector<PaletteImage>& pictures) const;

  private:
    /// All of a finish, what scatters light, or what shines and mirrors above it.
    enum class Layer { whole, matt, coat };

    /// Names of one material's finishes, where they are known.
    struct FinishNames {
        Material material;
        std::array<std::string, 3> names; ///< by Layer
    };

    void append_layered(std::string& text, const PlacementGroup& group);
    void append_picture(std::string& text, const PlacementGroup& group);
    void append_pattern(std::string& text, const Material& material, const PathTint& tint, double size);
    void append_plain(std::string& text, Rgb rgb, const Material& material);
    void append_surface(std::string& text, std::string_view pigment, const Material& material,
                        std::string_view normal = {});
    void append_shape(std::string& text, std::string_view pattern, std::string_view pigment,
                      const Material& material);
    const std::string& finish(const Material& material, Layer layer);
    std::string named_finish(const Material& material, Layer layer);
    static std::string name_of(const Material& material);
    const std::string& palette_name(std::uint32_t index, const std::string& clear);
    const std::string& picture_name(const Material& material);
    std::string file_name(const std::string& name) const;

    const Cut& cut_;
    std::string prefix_;
    std::string file_stem_;
    UniqueNames finish_names_;
    std::unordered_map<std::string, std::string> finish_by_text_;
    std::vector<std::string> finish_declarations_;
    /// Declared names, by index in the cut and what is said of light that goes through.
    std::map<std::pair<std::uint32_t, std::string>, std::string> palettes_;
    struct Picture {
        std::string name;
        bool has_clear_parts = false;
    };
    std::map<std::pair<std::string, std::string>, Picture> pictures_; ///< likewise, by Material::texture
    std::map<std::string, std::string> layers_;                       ///< by their text
    PovrayPatterns patterns_;
    FinishNames last_finish_;
    bool by_material_;
    std::deque<std::string> textures_;
    std::vector<std::string> materials_; ///< by texture: the name of its material
    IdTable texture_ids_;
    std::string text_; ///< of the texture under way
    double least_transmit_ = 1;
};

} // namespace graftal
