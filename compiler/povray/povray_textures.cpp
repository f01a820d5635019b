#include "compiler/povray/povray_textures.h"

#include <algorithm>
#include <functional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "compiler/povray/povray_palette.h"
#include "compiler/support/check.h"
#include "compiler/support/number.h"

namespace graftal {

namespace {

constexpr int colour_digits = 7; // half a unit is 1/300 of the last bit of a 16-bit picture
constexpr double no_tint = 1e-9; // alpha this near to 0 or 1 is as good as that
constexpr double least_roughness = 5e-4;

void append_rgb(std::string& text, Rgb rgb) {
    text += "rgb <";
    for (int i = 0; i < 3; ++i) {
        if (i > 0) text += ",";
        append_number(text, rgb[i], colour_digits);
    }
    text += ">";
}

std::string number_text(double value) {
    std::string text;
    append_number(text, value, colour_digits);
    return text;
}

std::string finish_text(const Material& m, bool shining) {
    std::string text = fmt::format("ambient {} diffuse {}", number_text(m.ambient), number_text(m.diffuse));
    if (m.translucency > 0) text += ", " + number_text(m.translucency);
    if (m.emission > 0) text += " emission " + number_text(m.emission);
    if (shining && m.specular > 0)
        text += fmt::format(" specular {} roughness {}", number_text(m.specular),
                            number_text(std::max(m.roughness, least_roughness)));
    if (shining && m.reflection > 0) text += fmt::format(" reflection {}", number_text(m.reflection));
    return text;
}

/// A texture up to the pigment that shows where the picture is not clear. What is clear must not shine
/// either.
std::string clear_or(const std::string& picture, std::string_view pattern) {
    return fmt::format("texture {{ {} {{ {}_shape }} texture_map {{ "
                       "[0.5 pigment {{ rgbt 1 }} finish {{ ambient 0 diffuse 0 }}] [0.5 pigment {{ ",
                       pattern, picture);
}

void begin_texture(std::string& text) {
    text += "texture { pigment { ";
}

void end_texture(std::string& text, const std::string& finish) {
    text += " } finish { ";
    text += finish;
    text += " } }";
}

} // namespace

PovrayTextures::PovrayTextures(const Cut& cut, const std::string& prefix, std::string file_stem,
                               bool by_material)
    : cut_(cut), prefix_(prefix), file_stem_(std::move(file_stem)), finish_names_(prefix + "F_"),
      by_material_(by_material) {}

std::string PovrayTextures::name_of(const Material& material) {
    return material.name.empty() ? "default" : material.name;
}

const std::string& PovrayTextures::finish(const Material& material, bool shining) {
    if (!(last_finish_.material == material)) last_finish_ = {material, {}, {}};
    std::string& name = shining ? last_finish_.shining : last_finish_.matt;
    if (name.empty()) name = named_finish(material, shining);
    return name;
}

std::string PovrayTextures::named_finish(const Material& material, bool shining) {
    const std::string text = finish_text(material, shining);
    std::string& name = finish_by_text_[text];
    if (name.empty()) {
        const std::string wish = name_of(material);
        name = finish_names_.next(text == finish_text(material, true) ? wish : wish + "_matt");
        finish_declarations_.push_back(fmt::format("#declare {} = finish {{ {} }}\n", name, text));
    }
    return name;
}

const std::string& PovrayTextures::palette_name(std::uint32_t index) {
    std::string& name = palettes_[index];
    if (name.empty()) name = fmt::format("{}P_{}", prefix_, palettes_.size());
    return name;
}

void PovrayTextures::append_plain(std::string& text, Rgb rgb, const Material& material) {
    begin_texture(text);
    append_rgb(text, rgb);
    end_texture(text, finish(material, true));
}

std::string PovrayTextures::plain(Rgb rgb, const Material& material) {
    std::string text;
    append_plain(text, rgb, material);
    return text;
}

void PovrayTextures::append_layered(std::string& text, const PlacementGroup& group) {
    const Palette& palette = cut_.palettes[group.palette];
    const PathTint& tint = group.tint;
    if (tint.alpha >= 1 - no_tint) return append_plain(text, tint.premultiplied, group.material);
    if (palette.size() == 1) return append_plain(text, tint.over(palette[0]), group.material);
    const std::string& shining = finish(group.material, true);
    begin_texture(text);
    text += palette_name(group.palette);
    if (tint.alpha <= no_tint) return end_texture(text, shining);
    least_transmit_ = std::min(least_transmit_, 1 - tint.alpha);
    // Highlights and reflections belong to the top layer alone: each layer adds its own.
    end_texture(text, finish(group.material, false));
    text += "\n          ";
    begin_texture(text);
    append_rgb(text, tint.premultiplied / tint.alpha);
    text += " transmit ";
    append_number(text, 1 - tint.alpha, colour_digits);
    end_texture(text, shining);
}

const std::string& PovrayTextures::picture_name(const std::string& texture) {
    std::string& name = pictures_[texture];
    if (name.empty()) name = fmt::format("{}I_{}", prefix_, pictures_.size());
    return name;
}

std::string PovrayTextures::ground(const Material& material, const Affine& pov_from_picture) {
    if (material.texture.empty()) return plain(material.rgb, material);
    const std::string& name = picture_name(material.texture);
    std::string text = clear_or(name, "pigment_pattern");
    text += name + " } finish { " + finish(material, true) + " }] } matrix <";
    constexpr int place_digits = 12;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 3; ++row) {
            if (column + row > 0) text += ",";
            append_number(
                text, column < 3 ? pov_from_picture.linear[column][row] : pov_from_picture.translation[row],
                place_digits);
        }
    return text + "> }";
}

/// The tint over the picture is the weighted mean of a colour and the picture, where there is any of it.
void PovrayTextures::append_picture(std::string& text, const PlacementGroup& group) {
    const std::string& name = picture_name(group.material.texture);
    const PathTint& tint = group.tint;
    text += clear_or(name, "uv_mapping pigment_pattern");
    if (tint.alpha <= no_tint) {
        text += name;
    } else if (tint.alpha >= 1 - no_tint) {
        append_rgb(text, tint.premultiplied);
    } else {
        text += "average pigment_map { [";
        append_number(text, 1 - tint.alpha, colour_digits);
        text += " " + name + "] [";
        append_number(text, tint.alpha, colour_digits);
        text += " ";
        append_rgb(text, tint.premultiplied / tint.alpha);
        text += "] }";
    }
    text += " } finish { " + finish(group.material, true) + " }] } }";
}

std::uint32_t PovrayTextures::texture_of(const PlacementGroup& group) {
    GRAFTAL_CHECK(group.palette < cut_.palettes.size() && !cut_.palettes[group.palette].empty(),
                  "emit_povray: a group without colours");
    text_.clear();
    if (group.material.texture.empty())
        append_layered(text_, group);
    else
        append_picture(text_, group);
    const auto next = static_cast<std::uint32_t>(textures_.size());
    const std::string material = by_material_ ? name_of(group.material) : std::string();
    const std::uint32_t index =
        texture_ids_.find_or_add(std::hash<std::string>()(text_), next, [&](std::uint32_t other) {
            return textures_[other] == text_ && materials_[other] == material;
        });
    if (index == next) {
        textures_.push_back(text_);
        materials_.push_back(material);
    }
    return index;
}

PovrayTextures::Overridable PovrayTextures::overridable() const {
    Overridable result;
    result.names.resize(textures_.size());
    std::vector<std::string> materials; // in the order of their first textures
    std::unordered_map<std::string, std::vector<std::size_t>> textures_of;
    for (std::size_t i = 0; i < textures_.size(); ++i) {
        std::vector<std::size_t>& textures = textures_of[materials_[i]];
        if (textures.empty()) materials.push_back(materials_[i]);
        textures.push_back(i);
    }
    UniqueNames names(prefix_ + "T_");
    for (const std::string& material : materials)
        result.materials.push_back(names.next(material));
    for (std::size_t m = 0; m < materials.size(); ++m) {
        const std::string& name = result.materials[m];
        const std::vector<std::size_t>& textures = textures_of[materials[m]];
        std::string own = fmt::format("#ifndef ({})\n", name), given = "#else\n";
        for (const std::size_t i : textures) {
            result.names[i] = textures.size() == 1 ? name : names.next(materials[m]);
            own += fmt::format("#declare {} = {}\n", result.names[i], textures_[i]);
            given += fmt::format("#declare {} = texture {{ {} }}\n", result.names[i], name);
        }
        result.declarations += own + (textures.size() == 1 ? "" : given) + "#end\n";
    }
    return result;
}

std::string PovrayTextures::file_name(const std::string& name) const {
    const std::string_view own = std::string_view(name).substr(prefix_.size());
    return fmt::format("{}_{}.png", file_stem_, own);
}

std::string PovrayTextures::declarations(std::vector<PaletteImage>& pictures) const {
    std::string text;
    for (const std::string& declaration : finish_declarations_)
        text += declaration;
    for (const auto& [index, name] : palettes_) {
        const Palette& palette = cut_.palettes[index];
        text +=
            fmt::format("#declare {} = pigment {{ {} }}\n", name, palette_pigment(palette, file_name(name)));
        if (PaletteLayout(static_cast<std::uint32_t>(palette.size())).picture())
            pictures.push_back(palette_image(palette, file_name(name)));
    }
    for (const auto& [texture, name] : pictures_) {
        // With use_alpha the pattern is 1 where the picture is clear.
        text += fmt::format("#declare {0} = pigment {{ image_map {{ png \"{1}\" }} }}\n"
                            "#declare {0}_shape = pigment {{ image_pattern {{ png \"{1}\" use_alpha }} "
                            "color_map {{ [0 rgb 1] [1 rgb 0] }} }}\n",
                            name, file_name(name));
        pictures.push_back({.file_name = file_name(name), .texture = texture});
    }
    return text;
}

} // namespace graftal
