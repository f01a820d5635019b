#include "compiler/povray/emit/textures.h"

#include <algorithm>
#include <functional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "compiler/povray/emit/palette.h"
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

/// The part of a finish that scatters light.
std::string matt_text(const Material& m) {
    std::string text = fmt::format("ambient {} diffuse {}", number_text(m.ambient), number_text(m.diffuse));
    if (m.translucency > 0) text += ", " + number_text(m.translucency);
    if (m.emission > 0) text += " emission " + number_text(m.emission);
    return text;
}

/// The part of a finish that shines and mirrors.
std::string shine_text(const Material& m) {
    std::string text;
    if (m.specular > 0)
        text += fmt::format(" specular {} roughness {}", number_text(m.specular),
                            number_text(std::max(m.roughness, least_roughness)));
    if (m.specular > 0 && m.metallic > 0) text += " metallic " + number_text(m.metallic);
    if (m.reflection > 0 && m.has_coat())
        text += fmt::format(" reflection {{ 0, {} fresnel on }} conserve_energy", number_text(m.reflection));
    else if (m.reflection > 0 && m.metallic > 0)
        text += fmt::format(" reflection {{ {} metallic {} }}", number_text(m.reflection),
                            number_text(m.metallic));
    else if (m.reflection > 0)
        text += fmt::format(" reflection {}", number_text(m.reflection));
    if (m.reflection > 0 && m.is_transparent() && !m.has_coat()) text += " conserve_energy";
    return text;
}

/// A pigment's words for light that goes through (trace/shade/optics.h).
std::string clearness(const Material& m) {
    if (!m.is_transparent()) return {};
    const double filter = m.surface_filter();
    if (filter == 0) return "transmit " + number_text(m.transparency);
    std::string text = "filter " + number_text(m.transparency * filter);
    if (filter < 1) text += " transmit " + number_text(m.transparency * (1 - filter));
    return text;
}

std::string colour_text(Rgb rgb, const std::string& clear) {
    std::string text;
    append_rgb(text, rgb);
    if (!clear.empty()) text += " " + clear;
    return text;
}

/// A tint over a pigment.
std::string mean_text(const std::string& pigment, const PathTint& tint, const std::string& clear) {
    return fmt::format("average pigment_map {{ [{} {}] [{} {}] }}", number_text(1 - tint.alpha), pigment,
                       number_text(tint.alpha), colour_text(tint.premultiplied / tint.alpha, clear));
}

void begin_texture(std::string& text) {
    text += "texture { pigment { ";
}

void end_texture(std::string& text, const std::string& finish, std::string_view normal = {}) {
    text += " }";
    text += normal;
    text += " finish { ";
    text += finish;
    text += " } }";
}

} // namespace

PovrayTextures::PovrayTextures(const Cut& cut, const PovrayUnits& units, const std::string& prefix,
                               std::string file_stem, bool by_material)
    : cut_(cut), prefix_(prefix), file_stem_(std::move(file_stem)), finish_names_(prefix + "F_"),
      patterns_(prefix, units), by_material_(by_material) {}

std::string PovrayTextures::name_of(const Material& material) {
    return material.name.empty() ? "default" : material.name;
}

const std::string& PovrayTextures::finish(const Material& material, Layer layer) {
    if (!(last_finish_.material == material)) last_finish_ = {material, {}};
    std::string& name = last_finish_.names[static_cast<std::size_t>(layer)];
    if (name.empty()) name = named_finish(material, layer);
    return name;
}

std::string PovrayTextures::named_finish(const Material& material, Layer layer) {
    const std::string matt = matt_text(material), shine = shine_text(material);
    const std::string text = layer == Layer::matt   ? matt
                             : layer == Layer::coat ? "ambient 0 diffuse 0" + shine
                                                    : matt + shine;
    std::string& name = finish_by_text_[text];
    if (name.empty()) {
        const std::string wish = name_of(material);
        const std::string_view ending = layer == Layer::coat                     ? "_coat"
                                        : layer == Layer::matt && !shine.empty() ? "_matt"
                                                                                 : "";
        name = finish_names_.next(wish + std::string(ending));
        finish_declarations_.push_back(fmt::format("#declare {} = finish {{ {} }}\n", name, text));
    }
    return name;
}

const std::string& PovrayTextures::palette_name(std::uint32_t index, const std::string& clear) {
    std::string& name = palettes_[{index, clear}];
    if (name.empty()) name = fmt::format("{}P_{}", prefix_, palettes_.size());
    return name;
}

void PovrayTextures::append_plain(std::string& text, Rgb rgb, const Material& material) {
    append_surface(text, colour_text(rgb, clearness(material)), material);
}

/// One layer, and above it a clear one that reflects if there is a coat.
void PovrayTextures::append_surface(std::string& text, std::string_view pigment, const Material& material,
                                    std::string_view normal) {
    begin_texture(text);
    text += pigment;
    end_texture(text, finish(material, material.has_coat() ? Layer::matt : Layer::whole), normal);
    if (!material.has_coat()) return;
    text += "\n          texture { pigment { rgbt 1";
    end_texture(text, finish(material, Layer::coat), normal);
}

/// Colours of a pattern behind a tint, and its relief.
void PovrayTextures::append_pattern(std::string& text, const Material& material, const PathTint& tint,
                                    double size) {
    const std::string clear = clearness(material);
    const auto entry = [&](const char* value, Rgb rgb) {
        return fmt::format(" [{} {}]", value, colour_text(tint.over(rgb), clear));
    };
    append_surface(text,
                   fmt::format("function {{ {} }} color_map {{{}{}{} }}",
                               patterns_.value(material.pattern, size), entry("0", material.pattern.low),
                               entry("0.5", material.rgb), entry("1", material.pattern.high)),
                   material, patterns_.relief(material.pattern, size));
}

std::string PovrayTextures::plain(Rgb rgb, const Material& material) {
    std::string text;
    append_plain(text, rgb, material);
    return text;
}

void PovrayTextures::append_layered(std::string& text, const PlacementGroup& group) {
    const Palette& palette = cut_.palettes[group.palette];
    const PathTint& tint = group.tint;
    const Material& material = group.material;
    if (tint.alpha >= 1 - no_tint) return append_plain(text, tint.premultiplied, material);
    if (palette.size() == 1) return append_plain(text, tint.over(palette[0]), material);
    const std::string clear = clearness(material);
    const std::string& name = palette_name(group.palette, clear);
    if (tint.alpha <= no_tint) return append_surface(text, name, material);
    // A surface that does more than scatter light needs the colour of both in one layer.
    if (material.is_transparent() || material.has_coat() || material.metallic > 0)
        return append_surface(text, mean_text(name, tint, clear), material);
    begin_texture(text);
    text += name;
    least_transmit_ = std::min(least_transmit_, 1 - tint.alpha);
    // Highlights and reflections belong to the top layer alone: each layer adds its own.
    end_texture(text, finish(material, Layer::matt));
    text += "\n          ";
    begin_texture(text);
    append_rgb(text, tint.premultiplied / tint.alpha);
    text += " transmit ";
    append_number(text, 1 - tint.alpha, colour_digits);
    end_texture(text, finish(material, Layer::whole));
}

const std::string& PovrayTextures::picture_name(const Material& material) {
    Picture& picture = pictures_[{material.texture, clearness(material)}];
    if (picture.name.empty())
        picture = {fmt::format("{}I_{}", prefix_, pictures_.size()), material.coverage < 1};
    return picture.name;
}

/// Where the picture is clear nothing, else this pigment. Each ray that comes to such a texture costs a ray
/// more behind it.
void PovrayTextures::append_shape(std::string& text, std::string_view pattern, std::string_view pigment,
                                  const Material& material) {
    text += fmt::format("texture {{ {} {{ {}_shape }} texture_map {{ "
                        "[0.5 pigment {{ rgbt 1 }} finish {{ ambient 0 diffuse 0 }}] [0.5 ",
                        pattern, picture_name(material));
    if (material.has_coat()) {
        // A map takes layers by name only.
        std::string layers;
        append_surface(layers, pigment, material);
        std::string& name = layers_[layers];
        if (name.empty()) name = fmt::format("{}L_{}", prefix_, layers_.size());
        text += name;
    } else {
        text += fmt::format("pigment {{ {} }} finish {{ {} }}", pigment, finish(material, Layer::whole));
    }
    text += "] }";
}

std::string PovrayTextures::ground(const Material& material, const Affine& pov_from_picture) {
    if (material.pattern) {
        std::string text;
        append_pattern(text, material, {}, 1);
        return text;
    }
    if (material.texture.empty()) return plain(material.rgb, material);
    std::string place = " matrix <";
    constexpr int place_digits = 12;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 3; ++row) {
            if (column + row > 0) place += ",";
            append_number(
                place, column < 3 ? pov_from_picture.linear[column][row] : pov_from_picture.translation[row],
                place_digits);
        }
    place += ">";
    std::string text;
    if (material.coverage == 1) {
        append_surface(text, picture_name(material) + place, material);
    } else {
        append_shape(text, "pigment_pattern", picture_name(material), material);
        text += place + " }";
    }
    return text;
}

/// The tint over the picture is the weighted mean of a colour and the picture, where there is any of it.
void PovrayTextures::append_picture(std::string& text, const PlacementGroup& group) {
    const Material& material = group.material;
    const PathTint& tint = group.tint;
    if (material.coverage == 1 && tint.alpha >= 1 - no_tint)
        return append_plain(text, tint.premultiplied, material);
    const std::string& name = picture_name(material);
    const std::string pigment = tint.alpha <= no_tint ? name
                                : tint.alpha >= 1 - no_tint
                                    ? colour_text(tint.premultiplied, clearness(material))
                                    : mean_text(name, tint, clearness(material));
    if (material.coverage == 1) {
        append_surface(text, "uv_mapping " + pigment, material);
    } else {
        append_shape(text, "uv_mapping pigment_pattern", pigment, material);
        text += " }";
    }
}

std::uint32_t PovrayTextures::texture_of(const PlacementGroup& group) {
    GRAFTAL_CHECK(group.palette < cut_.palettes.size() && !cut_.palettes[group.palette].empty(),
                  "emit_povray: a group without colours");
    text_.clear();
    if (group.material.pattern)
        append_pattern(text_, group.material, group.tint, group.pattern_size);
    else if (group.material.texture.empty())
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
    for (const auto& [key, name] : palettes_) {
        const Palette& palette = cut_.palettes[key.first];
        text += fmt::format("#declare {} = pigment {{ {} }}\n", name,
                            palette_pigment(palette, file_name(name), key.second));
        if (PaletteLayout(static_cast<std::uint32_t>(palette.size())).picture())
            pictures.push_back(palette_image(palette, file_name(name)));
    }
    for (const auto& [key, picture] : pictures_) {
        const std::string file = file_name(picture.name);
        text += fmt::format("#declare {} = pigment {{ image_map {{ png \"{}\" {}}} }}\n", picture.name, file,
                            clear_image(key.second));
        // The pattern of use_alpha is 1 where the picture is clear.
        if (picture.has_clear_parts)
            text += fmt::format("#declare {}_shape = pigment {{ image_pattern {{ png \"{}\" use_alpha }} "
                                "color_map {{ [0 rgb 1] [1 rgb 0] }} }}\n",
                                picture.name, file);
        pictures.push_back({.file_name = file, .texture = key.first});
    }
    for (const auto& [layers, name] : layers_)
        text += fmt::format("#declare {} = {}\n", name, layers);
    return text + patterns_.declarations();
}

} // namespace graftal
