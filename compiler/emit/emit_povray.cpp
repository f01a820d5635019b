#include "compiler/emit/emit_povray.h"

#include <algorithm>
#include <cstdint>
#include <string_view>

#include <fmt/format.h>

#include "compiler/emit/povray_bodies.h"
#include "compiler/emit/povray_names.h"
#include "compiler/emit/povray_textures.h"
#include "compiler/emit/povray_view.h"
#include "compiler/emit/sdl_writer.h"
#include "compiler/scene/ground.h"
#include "compiler/support/check.h"

namespace graftal {

namespace {

/// POV-Ray leaves out a layer that contributes less than its adc_bailout, by default 1/255: hundreds of times
/// what a 16-bit picture shows.
constexpr double default_bailout = 1.0 / 255;
constexpr std::string_view fine_bailout = "adc_bailout 1e-6";

/// Placements begin to end - 1 of one group.
struct Run {
    std::uint32_t group;
    std::size_t begin, end;
};

/// What becomes one union: all placements of one texture, whatever groups they come from.
struct Bucket {
    std::uint32_t texture;
    std::vector<Run> runs;
    std::uint64_t count = 0;
};

/// Planes are objects of their own: an infinite part would take a union out of POV-Ray's tree.
struct Plane {
    std::uint32_t texture;
    const Placement* placement;
};

class Emitter {
  public:
    Emitter(const Cut& cut, const PovrayOptions& options, const PovrayUnits& units, const TextSink& sink)
        : cut_(cut), options_(options), units_(units), out_(sink),
          identifier_(model_identifier(options.scene_name)),
          prefix_(options.include ? identifier_ + "_" : ""), bodies_(cut, prefix_),
          textures_(cut, prefix_, harmless(options.scene_name)),
          progress_(out_, cut.placement_count + bodies_.triangle_count(), options.progress) {
        sort_into_buckets();
    }

    bool write_scene(const View& view, std::vector<PaletteImage>& pictures);
    bool write_include(std::vector<PaletteImage>& pictures);

  private:
    void sort_into_buckets();
    void write_header();
    bool write_objects();
    bool write_bucket(const Bucket& bucket);
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
};

void Emitter::sort_into_buckets() {
    std::vector<std::uint32_t> bucket_of_texture;
    for (std::uint32_t g = 0; g < cut_.groups.size(); ++g) {
        const PlacementGroup& group = cut_.groups[g];
        if (group.placements.empty()) continue;
        const std::uint32_t texture = textures_.texture_of(group);
        if (texture == bucket_of_texture.size()) {
            bucket_of_texture.push_back(static_cast<std::uint32_t>(buckets_.size()));
            buckets_.push_back({.texture = texture});
        }
        Bucket& bucket = buckets_[bucket_of_texture[texture]];
        std::size_t begin = 0;
        const auto close_run = [&](std::size_t end) {
            if (end > begin) bucket.runs.push_back({g, begin, end});
            bucket.count += end - begin;
            begin = end + 1;
        };
        for (std::size_t i = 0; i < group.placements.size(); ++i) {
            if (!bodies_.is_plane(group.placements[i].body)) continue;
            planes_.push_back({texture, &group.placements[i]});
            close_run(i);
        }
        close_run(group.placements.size());
    }
    std::erase_if(buckets_, [](const Bucket& bucket) { return bucket.count == 0; });
}

void Emitter::write_header() {
    out_ << "#version 3.7;\n// " << harmless(options_.scene_name) << ": "
         << fmt::format("{} placements of {} bodies, {} triangles in meshes, drawing {:.4g} leaves.\n",
                        cut_.placement_count, cut_.bodies.size(), bodies_.triangle_count(), cut_.leaf_count)
         << "// Written by graftal. The model's space is right-handed, y up";
}

bool Emitter::write_bucket(const Bucket& bucket) {
    const std::string& texture = textures_.all()[bucket.texture];
    const Affine pov_from_world = units_.pov_from_world();
    const bool single = bucket.count == 1;
    if (!single) out_ << "union {\n";
    for (const Run& run : bucket.runs)
        for (std::size_t i = run.begin; i < run.end && !out_.stopped(); ++i) {
            const Placement& placement = cut_.groups[run.group].placements[i];
            bodies_.place(out_, placement.body, pov_from_world * placement.world_from_body,
                          single ? std::string_view(texture) : std::string_view());
            progress_.step();
        }
    if (!single) out_ << "  " << texture << "\n}\n";
    return !out_.stopped();
}

bool Emitter::write_objects() {
    for (const Bucket& bucket : buckets_)
        if (!write_bucket(bucket)) return false;
    for (const Plane& plane : planes_)
        bodies_.place(out_, plane.placement->body, units_.pov_from_world() * plane.placement->world_from_body,
                      textures_.all()[plane.texture]);
    return !out_.stopped();
}

bool reflects(const Cut& cut, const View& view) {
    return (view.ground && view.ground->material.reflection > 0) ||
           std::any_of(cut.groups.begin(), cut.groups.end(),
                       [](const PlacementGroup& group) { return group.material.reflection > 0; });
}

bool Emitter::write_scene(const View& view, std::vector<PaletteImage>& pictures) {
    write_header();
    const Vec3 origin = units_.origin;
    out_ << "; the camera mirrors it into POV-Ray's.\n// 1 unit of the model is ";
    out_.number(units_.scale, 6) << " here; <0,0,0> here is ";
    out_.vector(origin, 12) << " of the model.\n\nglobal_settings { assumed_gamma 1";
    if (needs_fine_bailout()) out_ << " " << fine_bailout;
    out_ << (reflects(cut_, view) ? std::string_view(" max_trace_level 8 }\n") : " }\n");
    const std::string ground =
        view.ground ? textures_.ground(view.ground->material,
                                       units_.pov_from_world() * world_from_picture(*view.ground))
                    : "";
    out_ << textures_.declarations(pictures) << "\n";
    write_view(out_, view, units_, cut_.bounds.empty() ? Vec3(0.0) : cut_.bounds.centre(), ground);
    if (!bodies_.declare(out_, progress_)) return false;
    out_ << "\n";
    return write_objects() && out_.flush();
}

bool Emitter::write_include(std::vector<PaletteImage>& pictures) {
    write_header();
    out_ << ", and its colours are linear light.\n// In a scene of your own, with assumed_gamma 1";
    if (needs_fine_bailout()) out_ << " and " << fine_bailout;
    out_ << ":\n"
         << fmt::format("//     #include \"{}\"\n", harmless(options_.file_name))
         << fmt::format("//     object {{ {} }}                   // right-handed\n", identifier_)
         << fmt::format(
                "//     object {{ {} scale <1,1,-1> }}    // for a camera with look_at, left-handed\n",
                identifier_);
    out_ << textures_.declarations(pictures);
    if (!bodies_.declare(out_, progress_)) return false;
    out_ << "\n#declare " << identifier_ << " =\n";
    const bool single = buckets_.size() + planes_.size() == 1;
    if (!single) out_ << "union {\n";
    if (!write_objects()) return false;
    if (!single) out_ << "}\n";
    return out_.flush();
}

} // namespace

bool emit_povray(const Graph&, const Cut& cut, const View& view, const PovrayOptions& options,
                 const TextSink& sink, std::vector<PaletteImage>& palettes) {
    if (options.include) return Emitter(cut, options, PovrayUnits{}, sink).write_include(palettes);
    return Emitter(cut, options, choose_units(cut, view.camera), sink).write_scene(view, palettes);
}

} // namespace graftal
