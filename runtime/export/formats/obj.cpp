// Wavefront OBJ, and its materials (MTL).

#include <filesystem>
#include <map>

#include "runtime/export/formats/flat_files.h"
#include "runtime/export/formats/picture_copies.h"

namespace graftal {

namespace {

/// A material of the MTL: one of the model, in a colour.
struct MtlKey {
    std::optional<MaterialId> material;
    std::array<std::uint8_t, 3> srgb{};
    auto operator<=>(const MtlKey&) const = default;
};

/// Bytes that a vertex, a normal, a triangle and a place on a picture take, about.
constexpr std::uint64_t obj_vertex_bytes = 34, obj_normal_bytes = 33, obj_triangle_bytes = 48,
                        obj_uv_bytes = 24;

class ObjWriter {
  public:
    ObjWriter(const ExportJob& job, OutputFile& obj, PictureCopies& pictures)
        : job_(job), obj_(obj), pictures_(pictures), meshes_(job.scene) {}

    void add(const SceneLeaf& leaf) {
        const ShapeMesh& mesh = meshes_.of(leaf.shape, leaf.look);
        use(leaf.look);
        const PlacedShape placed(mesh, leaf.world_from_shape);
        for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
            triple("v", placed.vertex(i));
        for (std::size_t i = 0; i < mesh.normals.size(); ++i)
            triple("vn", placed.normal(i));
        for (const auto& uv : mesh.uv)
            obj_.print("vt {} {}\n", static_cast<float>(uv[0]), static_cast<float>(uv[1]));
        for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
            obj_.text("f");
            for (const std::uint32_t corner : placed.triangle(i)) {
                const std::uint64_t number = vertices_ + corner + 1;
                if (mesh.uv.empty())
                    obj_.print(" {0}//{0}", number);
                else
                    obj_.print(" {0}/{1}/{0}", number, uv_ + corner + 1);
            }
            obj_.text("\n");
        }
        vertices_ += mesh.vertices.size();
        uv_ += mesh.uv.size();
        triangles_ += mesh.triangles.size();
    }

    void write_materials(OutputFile& mtl) const {
        for (const auto& [key, number] : materials_) {
            const Rgb rgb = colours_.at(number);
            mtl.print("newmtl {}\n", name(key, number));
            mtl.print("Kd {} {} {}\n", float_text(rgb.r), float_text(rgb.g), float_text(rgb.b));
            if (!key.material) {
                mtl.text("illum 1\n\n");
                continue;
            }
            const Material& material = job_.scene.materials[*key.material];
            const double specular = std::max(material.specular, material.reflection);
            mtl.print("Ks {0} {0} {0}\n", float_text(specular));
            // The width of a highlight by Blinn's exponent.
            const double roughness = std::max(material.roughness, 1e-3);
            mtl.print("Ns {}\n", float_text(std::min(1 / roughness, 1000.0)));
            if (material.emission > 0) {
                const Rgb light = material.emission * rgb;
                mtl.print("Ke {} {} {}\n", float_text(light.r), float_text(light.g), float_text(light.b));
            }
            if (material.transparency > 0) mtl.print("d {}\n", float_text(1 - material.transparency));
            if (material.has_coat()) mtl.print("Ni {}\n", float_text(material.ior));
            mtl.text("illum 2\n");
            if (!material.texture.empty()) mtl.print("map_Kd {}\n", pictures_.name(*key.material));
            mtl.text("\n");
        }
    }

    std::uint64_t triangles() const { return triangles_; }
    std::size_t materials() const { return materials_.size(); }

  private:
    void triple(std::string_view word, Vec3 v) {
        obj_.print("{} {} {} {}\n", word, static_cast<float>(v.x) + 0.0f, static_cast<float>(v.y) + 0.0f,
                   static_cast<float>(v.z) + 0.0f);
    }

    void use(const SceneLook& look) {
        // A picture shows its own colours, behind the tint's.
        const Rgb colour = look.colour();
        const MtlKey key{look.material, srgb_bytes(colour)};
        const auto [known, is_new] = materials_.try_emplace(key, materials_.size());
        if (is_new) colours_.push_back(colour);
        if (current_ == known->second) return;
        current_ = known->second;
        obj_.print("usemtl {}\n", name(key, current_));
    }

    /// A word of MTL files ends at a blank.
    std::string name(const MtlKey& key, std::size_t number) const {
        if (!key.material) return fmt::format("colour_{}", number);
        return fmt::format("{}_{}", job_.scene.materials[*key.material].name, number);
    }

    const ExportJob& job_;
    OutputFile& obj_;
    PictureCopies& pictures_;
    ShapeMeshes meshes_;
    std::map<MtlKey, std::size_t> materials_;
    std::vector<Rgb> colours_; ///< linear, by number
    std::size_t current_ = SIZE_MAX;
    std::uint64_t vertices_ = 0, uv_ = 0, triangles_ = 0;
};

Status write_obj(const ExportJob& job, ExportReport& report) {
    const bool pictures = has_pictures(job.scene);
    const auto bytes = [&](const SceneShape& shape) {
        const MeshSize size = mesh_size(shape, pictures);
        return size.vertices * (obj_vertex_bytes + obj_normal_bytes + (pictures ? obj_uv_bytes : 0)) +
               size.triangles * obj_triangle_bytes;
    };
    if (refuse_range(job, 1) || refuse_size(job, bytes)) return {};
    const std::filesystem::path path = job.options.output;
    std::filesystem::path mtl_path = path;
    mtl_path.replace_extension(".mtl");
    OutputFile obj(path.string(), job.options.most_bytes, job.too_large);
    OutputFile mtl(mtl_path.string(), job.options.most_bytes, job.too_large);
    PictureCopies copies(job);
    for (const Status* status : {&obj.status(), &mtl.status()})
        if (!status->ok()) return *status;
    for (const std::string& line : comment_lines(job.options.metadata)) {
        obj.print("# {}\n", line);
        mtl.print("# {}\n", line);
    }
    obj.print("mtllib {}\n", mtl_path.filename().string());
    ObjWriter writer(job, obj, copies);
    Status status = for_each_leaf(job, obj, [&](const SceneLeaf& leaf) { writer.add(leaf); });
    if (!status.ok()) return status;
    writer.write_materials(mtl);
    for (OutputFile* const file : {&obj, &mtl})
        if (status = file->close(); !status.ok()) return status;
    report.summary = fmt::format("{} triangles, {} materials", writer.triangles(), writer.materials());
    return copies.commit({&mtl.pending(), &obj.pending()});
}

} // namespace

const ExportFormat obj_format = {
    .extension = ".obj",
    .name = "Wavefront OBJ",
    .summary = "every triangle, with its normals and places on pictures; colours in an .mtl beside it",
    .meshes = SceneMeshes::by_size,
    .write = write_obj,
};

} // namespace graftal
