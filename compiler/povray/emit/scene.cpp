#include "compiler/povray/emit/scene.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>
#include <string_view>
#include <tuple>

#include <fmt/format.h>

#include "compiler/povray/emit/bodies.h"
#include "compiler/povray/emit/names.h"
#include "compiler/povray/emit/textures.h"
#include "compiler/povray/emit/view.h"
#include "compiler/povray/sdl_writer.h"
#include "compiler/primitives/primitive.h"
#include "compiler/scene/ground.h"
#include "compiler/support/check.h"
#include "compiler/support/number.h"

namespace graftal {

namespace {

/// POV-Ray leaves out a layer that contributes less than its adc_bailout, by default 1/255: hundreds of times
/// what a 16-bit picture shows.
constexpr double default_bailout = 1.0 / 255;
constexpr std::string_view fine_bailout = "adc_bailout 1e-6";

/// Placements begin to end - 1 of one group.
struct Range {
    std::uint32_t group;
    std::size_t begin, end;
};

/// One union of the scene: all placements of one texture and interior, whatever groups they come from.
struct Bucket {
    std::uint32_t texture;
    std::optional<Interior> interior;
    std::vector<Range> ranges;
    std::vector<const PackedPlacements*> packed;
    std::uint64_t count = 0;
    bool translucent = false; ///< and not transparent, nor an operand's
};

/// Planes are objects of their own: an infinite part would take a union out of POV-Ray's tree.
struct Plane {
    std::uint32_t texture;
    std::optional<Interior> interior;
    const Placement* placement;
};

/// The pictures of a scene are named as its file is: several of one model may lie side by side.
std::string picture_stem(const PovrayOptions& options) {
    std::string_view name = options.file_name;
    if (name.empty()) return harmless(options.scene_name);
    if (name.ends_with(".inc") || name.ends_with(".pov")) name.remove_suffix(4);
    return harmless(name);
}

/// Nothing where no ray asks for it.
std::optional<Interior> declared_interior(const Material& material) {
    if (!material.is_transparent() && !material.has_coat()) return std::nullopt;
    return interior_of(material);
}

/// The text for sheets, whose two faces are one surface where light comes through: seen from within, each
/// face is clear. A ray that looks from one face for a light behind the sheet does not end at the other.
std::string sheet_texture_of(std::string texture) {
    constexpr std::string_view clear_within = " interior_texture { pigment { rgbt 1 } }", end = " #end";
    const std::size_t place = texture.ends_with(end) ? texture.size() - end.size() : texture.size();
    return texture.insert(place, clear_within);
}

class Emitter {
  public:
    Emitter(const Cut& cut, const PovrayOptions& options, const PovrayUnits& units, const TextSink& sink)
        : cut_(cut), options_(options), units_(units), out_(sink),
          identifier_(options.identifier.empty() ? model_identifier(options.scene_name) : options.identifier),
          prefix_(options.include ? identifier_ + "_" : ""), bodies_(cut, prefix_),
          textures_(cut, units, prefix_, picture_stem(options), options.include),
          progress_(out_, cut.placement_count + bodies_.triangle_count(), options.progress) {
        sort_into_buckets();
    }

    bool write_scene(const View& view, std::vector<PaletteImage>& pictures);
    bool write_include(std::vector<PaletteImage>& pictures);

  private:
    void sort_into_buckets();
    void write_header();
    bool write_objects();
    template<typename Visit> void for_each_of(const Bucket& bucket, const Visit& visit) const;
    bool write_bucket(const Bucket& bucket, double growth = 0);
    bool write_union(const Bucket& bucket, std::uint64_t count, const std::string& texture, double growth,
                     std::optional<bool> sheets);
    bool write_combined(std::uint32_t number, double growth = 0);
    bool write_operand(std::uint32_t operand, double growth);
    Affine grown(std::uint32_t body, double growth) const;
    bool is_empty(const CombinedPart& part) const;
    std::optional<Interior> interior_of_part(const CombinedPart& part) const;
    std::string interior_text(const Interior& interior) const;
    void write_usage(const std::vector<std::string>& materials, bool pictures);
    bool needs_fine_bailout() const { return textures_.least_transmit() < default_bailout; }

    const Cut& cut_;
    const PovrayOptions& options_;
    const PovrayUnits units_;
    SdlWriter out_;
    const std::string identifier_;
    const std::string prefix_;
    PovrayBodies bodies_;
    PovrayTextures textures_;
    ProgressMarks progress_;
    std::vector<Bucket> buckets_;
    std::vector<Plane> planes_;
    /// Solids by the operand that they are parts of, and those that stand in the scene.
    std::map<std::uint32_t, std::vector<Bucket>> parts_of_operand_;
    std::map<std::uint32_t, std::vector<std::uint32_t>> combined_of_operand_;
    std::vector<std::string> texture_texts_; ///< by texture: what stands at the objects
};

void Emitter::sort_into_buckets() {
    std::vector<std::vector<std::uint32_t>> buckets_of_texture;
    for (std::uint32_t g = 0; g < cut_.groups.size(); ++g) {
        const PlacementGroup& group = cut_.groups[g];
        if (group.placements.empty() && group.packed.empty()) continue;
        const std::uint32_t texture = textures_.texture_of(group);
        const std::optional<Interior> interior = declared_interior(group.material);
        if (texture == buckets_of_texture.size()) buckets_of_texture.emplace_back();
        if (group.operand != no_operand) {
            const std::size_t count = group.placements.size();
            parts_of_operand_[group.operand].push_back({texture, interior, {{g, 0, count}}, {}, count});
            continue;
        }
        std::vector<std::uint32_t>& alike = buckets_of_texture[texture];
        const auto known =
            std::ranges::find(alike, interior, [&](std::uint32_t b) { return buckets_[b].interior; });
        const std::uint32_t number =
            known == alike.end() ? static_cast<std::uint32_t>(buckets_.size()) : *known;
        if (known == alike.end()) {
            alike.push_back(number);
            buckets_.push_back(
                {.texture = texture,
                 .interior = interior,
                 .translucent = group.material.translucency > 0 && !group.material.is_transparent()});
        }
        Bucket& bucket = buckets_[number];
        std::size_t begin = 0;
        const auto close_range = [&](std::size_t end) {
            if (end > begin) bucket.ranges.push_back({g, begin, end});
            bucket.count += end - begin;
            begin = end + 1;
        };
        for (std::size_t i = 0; i < group.placements.size(); ++i) {
            if (!bodies_.is_plane(group.placements[i].body)) continue;
            planes_.push_back({texture, interior, &group.placements[i]});
            close_range(i);
        }
        close_range(group.placements.size());
        for (const PackedPlacements& parts : group.packed) {
            bucket.packed.push_back(&parts);
            bucket.count += parts.size();
        }
    }
    for (std::uint32_t i = static_cast<std::uint32_t>(cut_.combined.size()); i-- > 0;)
        if (!is_empty(cut_.combined[i])) combined_of_operand_[cut_.combined[i].holder].push_back(i);
    std::erase_if(buckets_, [](const Bucket& bucket) { return bucket.count == 0; });
    std::ranges::stable_sort(buckets_, {}, [](const Bucket& bucket) {
        const Interior interior = bucket.interior.value_or(Interior());
        return std::tuple(bucket.interior.has_value(), interior.ior, interior.absorbed.r, interior.absorbed.g,
                          interior.absorbed.b);
    });
}

void Emitter::write_header() {
    out_ << "#version 3.7;\n// " << harmless(options_.scene_name) << ": "
         << fmt::format("{} placements of {} bodies, {} triangles in meshes, drawing {:.4g} primitives.\n",
                        cut_.placement_count, cut_.bodies.size(), bodies_.triangle_count(), cut_.leaf_count)
         << "// Written by graftal. The model's space is right-handed, y up";
}

/// Scales a body a little about its middle.
Affine Emitter::grown(std::uint32_t body, double growth) const {
    const auto& shape = cut_.bodies[body].shape;
    const auto* const primitive = std::get_if<Primitive>(&shape);
    if (primitive && !traits_of(*primitive).bounded) return {};
    const Box bounds = primitive ? traits_of(*primitive).box(*primitive) : box_of(std::get<Mesh>(shape));
    const Vec3 middle = bounds.centre();
    return Affine::translate(middle) * Affine::scale(Vec3(1 + growth)) * Affine::translate(-middle);
}

/// Calls `visit(body, world_from_body)` on the placements.
template<typename Visit> void Emitter::for_each_of(const Bucket& bucket, const Visit& visit) const {
    for (const Range& range : bucket.ranges)
        for (std::size_t i = range.begin; i < range.end; ++i) {
            const Placement& placement = cut_.groups[range.group].placements[i];
            visit(placement.body, placement.world_from_body);
        }
    for (const PackedPlacements* const parts : bucket.packed)
        parts->for_each(
            [&](const Placement& placement) { visit(placement.body, placement.world_from_body); });
}

/// Sheets that let light through have a texture of their own.
bool Emitter::write_bucket(const Bucket& bucket, double growth) {
    std::uint64_t sheets = 0;
    if (bucket.translucent)
        for_each_of(bucket, [&](std::uint32_t body, const Affine& world_from_body) {
            sheets += bodies_.is_sheet(body, world_from_body.linear) ? 1 : 0;
        });
    const std::string& texture = texture_texts_[bucket.texture];
    if (sheets == 0) return write_union(bucket, bucket.count, texture, growth, {});
    const std::string sheet_texture = sheet_texture_of(texture);
    if (sheets == bucket.count) return write_union(bucket, sheets, sheet_texture, growth, {});
    out_ << "union {\n";
    if (!write_union(bucket, bucket.count - sheets, texture, growth, false)) return false;
    if (!write_union(bucket, sheets, sheet_texture, growth, true)) return false;
    out_ << "}\n";
    return !out_.stopped();
}

/// `sheets`: only they, or only the others; `count`: of what is to be written.
bool Emitter::write_union(const Bucket& bucket, std::uint64_t count, const std::string& texture,
                          double growth, std::optional<bool> sheets) {
    const Affine pov_from_world = units_.pov_from_world();
    const bool single = count == 1;
    if (!single) out_ << "union {\n";
    for_each_of(bucket, [&](std::uint32_t body, const Affine& world_from_body) {
        if (out_.stopped()) return;
        if (sheets && *sheets != bodies_.is_sheet(body, world_from_body.linear)) return;
        Affine pov_from_body = pov_from_world * world_from_body;
        if (growth > 0) pov_from_body = pov_from_body * grown(body, growth);
        bodies_.place(out_, body, pov_from_body, single ? std::string_view(texture) : std::string_view());
        progress_.step();
    });
    if (!single) out_ << "  " << texture << "\n}\n";
    return !out_.stopped();
}

/// Whether operands have no parts, so that nothing is left. Those within it are known.
bool Emitter::is_empty(const CombinedPart& part) const {
    const auto has_parts = [&](std::uint32_t operand) {
        return parts_of_operand_.contains(operand) || combined_of_operand_.contains(operand);
    };
    if (part.combination == Combination::subtract) return !has_parts(part.first_operand);
    for (std::uint32_t i = 0; i < part.operand_count; ++i)
        if (!has_parts(part.first_operand + i)) return true;
    return false;
}

/// The first that a part of it has: POV-Ray gives it to the whole.
std::optional<Interior> Emitter::interior_of_part(const CombinedPart& part) const {
    for (std::uint32_t i = 0; i < part.operand_count; ++i) {
        if (const auto parts = parts_of_operand_.find(part.first_operand + i);
            parts != parts_of_operand_.end())
            for (const Bucket& bucket : parts->second)
                if (bucket.interior) return bucket.interior;
        if (const auto held = combined_of_operand_.find(part.first_operand + i);
            held != combined_of_operand_.end())
            for (const std::uint32_t number : held->second)
                if (const auto interior = interior_of_part(cut_.combined[number])) return interior;
    }
    return std::nullopt;
}

/// Later operands grow a little more than the first, as a share of each body. Where their faces coincide,
/// POV-Ray would leave a skin of what is taken away, and mix the faces of an intersection. `growth`: of the
/// whole.
bool Emitter::write_combined(std::uint32_t number, double growth) {
    constexpr double more = 4e-6; // POV-Ray tells places of a body of size 1 apart to 1e-6
    const CombinedPart& part = cut_.combined[number];
    out_ << (part.combination == Combination::intersect ? "intersection {\n" : "difference {\n");
    for (std::uint32_t i = 0; i < part.operand_count; ++i)
        if (!write_operand(part.first_operand + i, i > 0 ? growth + more : growth)) return false;
    if (part.holder == no_operand)
        if (const auto interior = interior_of_part(part)) out_ << "  " << interior_text(*interior) << "\n";
    out_ << "}\n";
    return !out_.stopped();
}

bool Emitter::write_operand(std::uint32_t operand, double growth) {
    const auto parts = parts_of_operand_.find(operand);
    const auto held = combined_of_operand_.find(operand);
    const std::size_t count = (parts == parts_of_operand_.end() ? 0 : parts->second.size()) +
                              (held == combined_of_operand_.end() ? 0 : held->second.size());
    if (count > 1) out_ << "union {\n";
    if (parts != parts_of_operand_.end())
        for (const Bucket& bucket : parts->second)
            if (!write_bucket(bucket, growth)) return false;
    if (held != combined_of_operand_.end())
        for (const std::uint32_t number : held->second)
            if (!write_combined(number, growth)) return false;
    if (count > 1) out_ << "}\n";
    return !out_.stopped();
}

bool Emitter::write_objects() {
    // One interior for all that has it: a ray that enters one part may leave another.
    for (auto first = buckets_.begin(); first != buckets_.end();) {
        const auto next = std::find_if(
            first, buckets_.end(), [&](const Bucket& bucket) { return bucket.interior != first->interior; });
        if (first->interior) out_ << "union {\n";
        for (; first != next; ++first)
            if (!write_bucket(*first)) return false;
        const std::optional<Interior>& interior = std::prev(next)->interior;
        if (interior) out_ << "  " << interior_text(*interior) << "\n}\n";
    }
    for (const Plane& plane : planes_) {
        std::string look = texture_texts_[plane.texture];
        if (plane.interior) look += " " + interior_text(*plane.interior);
        bodies_.place(out_, plane.placement->body, units_.pov_from_world() * plane.placement->world_from_body,
                      look);
    }
    if (const auto whole = combined_of_operand_.find(no_operand); whole != combined_of_operand_.end())
        for (const std::uint32_t number : whole->second)
            if (!write_combined(number)) return false;
    return !out_.stopped();
}

/// Absorbed by a medium: POV-Ray's `fade_distance` dims nothing that lies in the solid.
std::string Emitter::interior_text(const Interior& interior) const {
    constexpr int digits = 9;
    std::string text = "interior { ior ";
    append_number(text, interior.ior, digits);
    if (interior.absorbed != Rgb(0.0)) {
        text += " media { method 1 intervals 1 samples 1,1 absorption rgb <";
        for (int c = 0; c < 3; ++c) {
            if (c > 0) text += ",";
            append_number(text, interior.absorbed[c] / units_.scale, digits);
        }
        text += "> }";
    }
    return text + " } hollow";
}

/// Whether rays go on from some surface.
bool leads_on(const Cut& cut, const View& view) {
    const auto leads = [](const Material& material) {
        return material.reflection > 0 || material.is_transparent();
    };
    return (view.ground && leads(view.ground->material)) ||
           std::ranges::any_of(cut.groups, leads, &PlacementGroup::material);
}

bool Emitter::write_scene(const View& view, std::vector<PaletteImage>& pictures) {
    write_header();
    texture_texts_.assign(textures_.all().begin(), textures_.all().end());
    const Vec3 origin = units_.origin;
    out_ << "; the camera mirrors it into POV-Ray's.\n// 1 unit of the model is ";
    out_.number(units_.scale, 6) << " here; <0,0,0> here is ";
    out_.vector(origin, 12) << " of the model.\n\nglobal_settings { assumed_gamma 1";
    if (view.sky_light) {
        out_ << " ambient_light rgb ";
        out_.vector(view.ambient_light(), 7);
    }
    if (needs_fine_bailout()) out_ << " " << fine_bailout;
    if (leads_on(cut_, view)) {
        const bool has_veils =
            std::ranges::any_of(cut_.groups, &Material::is_veil, &PlacementGroup::material);
        out_ << fmt::format(" max_trace_level {}",
                            has_veils ? Material::most_veils : Material::most_surfaces);
    }
    out_ << " }\n";
    std::string ground = view.ground
                             ? textures_.ground(view.ground->material,
                                                units_.pov_from_world() * world_from_picture(*view.ground))
                             : "";
    if (const auto interior = view.ground ? declared_interior(view.ground->material) : std::nullopt)
        ground += " " + interior_text(*interior);
    std::string sky_file;
    if (view.shows_sky_light && view.sky_light->picture) {
        sky_file = picture_stem(options_) + "_sky.exr";
        pictures.push_back({.file_name = sky_file,
                            .sky = view.sky_light->picture,
                            .sky_brightness = view.sky_light->brightness});
    }
    out_ << textures_.declarations(pictures) << "\n";
    write_view(out_, view, units_, cut_.bounds.empty() ? Vec3(0.0) : cut_.bounds.centre(),
               options_.lights.value_or(list_size(view.quality)), ground, sky_file);
    if (!bodies_.declare(out_, progress_)) return false;
    out_ << "\n";
    return write_objects() && out_.flush();
}

/// Writes comments at the beginning of an include file on how to use it.
void Emitter::write_usage(const std::vector<std::string>& materials, bool pictures) {
    constexpr std::size_t most_listed = 12;
    out_ << ", and its colours are linear light.\n// In a scene of your own, with assumed_gamma 1";
    if (needs_fine_bailout()) out_ << " and " << fine_bailout;
    const std::string file = harmless(options_.file_name);
    out_ << ":\n"
         << fmt::format("//     #include \"{}\"\n", file)
         << fmt::format("//     object {{ {} }}                   // right-handed\n", identifier_)
         << fmt::format(
                "//     object {{ {} scale <1,1,-1> }}    // for a camera with look_at, left-handed\n",
                identifier_)
         << "// If " << file << (pictures ? " and its pictures lie" : " lies")
         << " in another folder, say it to POV-Ray: povray +LFOLDER ...\n"
         << fmt::format("// Placed so, it lies between the corners {0}_min and {0}_max.\n", identifier_);
    if (textures_.all().size() == 1)
        out_ << fmt::format("// For a texture of your own: object {{ {} texture {{ ... }} }}\n", identifier_);
    else
        out_ << "// For one texture of your own in place of all, before the #include:\n"
             << fmt::format("//     #declare {0}_bare = yes;  and then  object {{ {0} texture {{ ... }} }}\n",
                            identifier_);
    out_ << "// For one material with another texture, before the #include:\n";
    for (std::size_t i = 0; i < std::min(materials.size(), most_listed); ++i)
        out_ << fmt::format("//     #declare {} = texture {{ ... }}\n", materials[i]);
    if (materials.size() > most_listed)
        out_ << fmt::format("//     and {} more, each after an #ifndef below\n",
                            materials.size() - most_listed);
}

bool Emitter::write_include(std::vector<PaletteImage>& pictures) {
    const PovrayTextures::Overridable textures = textures_.overridable();
    const bool several = textures.names.size() > 1;
    for (const std::string& name : textures.names)
        texture_texts_.push_back(
            several ? fmt::format("#ifndef ({}_bare) texture {{ {} }} #end", identifier_, name)
                    : fmt::format("texture {{ {} }}", name));
    const std::string declarations = textures_.declarations(pictures); // of the textures' parts
    write_header();
    write_usage(textures.materials, !pictures.empty());
    out_ << declarations << textures.declarations;
    if (!cut_.bounds.empty()) {
        out_ << fmt::format("#declare {}_min = ", identifier_);
        out_.vector(cut_.bounds.min, 9) << fmt::format(";\n#declare {}_max = ", identifier_);
        out_.vector(cut_.bounds.max, 9) << ";\n";
    }
    if (!bodies_.declare(out_, progress_)) return false;
    out_ << "\n#declare " << identifier_ << " =\n";
    const auto whole = combined_of_operand_.find(no_operand);
    const bool single =
        buckets_.size() + planes_.size() + (whole == combined_of_operand_.end() ? 0 : whole->second.size()) ==
        1;
    if (!single) out_ << "union {\n";
    if (!write_objects()) return false;
    if (!single) out_ << "}\n";
    return out_.flush();
}

} // namespace

bool emit_povray(const Cut& cut, const View& view, const PovrayOptions& options, const TextSink& sink,
                 std::vector<PaletteImage>& palettes) {
    if (options.include) return Emitter(cut, options, PovrayUnits{}, sink).write_include(palettes);
    return Emitter(cut, options, choose_units(cut, view.camera), sink).write_scene(view, palettes);
}

} // namespace graftal
