// Mitsuba 3: an XML scene, and all meshes in a .serialized file beside it. One level of instances.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <numbers>

#include <glm/geometric.hpp>
#include <zlib.h>

#include "compiler/support/number.h"
#include "runtime/export/formats/flat_files.h"
#include "runtime/export/formats/pbr.h"
#include "runtime/export/formats/renderer_scene.h"

namespace graftal {

namespace {

constexpr double mitsuba_triangle_bytes = 40, mitsuba_place_bytes = 330;

std::string xml_vector(Vec3 v) {
    return fmt::format("{}, {}, {}", shortest(v.x), shortest(v.y), shortest(v.z));
}

std::string xml_text(std::string_view text) {
    std::string escaped;
    for (const char c : text) {
        if (c == '&')
            escaped += "&amp;";
        else if (c == '<')
            escaped += "&lt;";
        else if (c == '"')
            escaped += "&quot;";
        else
            escaped += c;
    }
    return escaped;
}

/// Meshes in Mitsuba's own format, version 4: each compressed by zlib, a table of where they begin at the
/// end.
class SerializedMeshes {
  public:
    explicit SerializedMeshes(OutputFile& file) : file_(file) {}

    /// Returns its number.
    std::size_t add(const std::string& name, const GroupSurface& surface) {
        constexpr std::uint32_t has_normals = 1, has_uv = 2, single_precision = 0x1000;
        std::string bytes;
        const auto put = [&](const auto& value) {
            bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
        };
        put(has_normals | single_precision | (surface.uv.empty() ? 0 : has_uv));
        bytes.append(name.c_str(), name.size() + 1);
        put(static_cast<std::uint64_t>(surface.vertices.size()));
        put(static_cast<std::uint64_t>(surface.triangles.size()));
        for (const auto& v : surface.vertices)
            put(v);
        for (const auto& v : surface.normals)
            put(v);
        for (const auto& v : surface.uv)
            put(v);
        for (const auto& t : surface.triangles)
            put(t);
        uLongf size = compressBound(bytes.size());
        std::string packed(size, '\0');
        compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                  reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(), Z_DEFAULT_COMPRESSION);
        packed.resize(size);
        begins_.push_back(file_.size());
        file_.byte(0x1c);
        file_.byte(0x04);
        file_.byte(0x04);
        file_.byte(0x00);
        file_.text(packed);
        return begins_.size() - 1;
    }

    void finish() {
        for (const std::uint64_t begin : begins_) {
            file_.number(static_cast<std::uint32_t>(begin));
            file_.number(static_cast<std::uint32_t>(begin >> 32));
        }
        file_.number(static_cast<std::uint32_t>(begins_.size()));
    }

  private:
    OutputFile& file_;
    std::vector<std::uint64_t> begins_;
};

class MitsubaWriter {
  public:
    MitsubaWriter(const ExportJob& job, const RendererScene& renderer, OutputFile& file, OutputFile& meshes,
                  std::string meshes_name)
        : job_(job), renderer_(renderer), file_(file), packed_(meshes), meshes_name_(std::move(meshes_name)),
          meshes_(renderer.scene()), pictures_(job) {}

    Status write() {
        file_.text("<?xml version=\"1.0\" encoding=\"utf-8\"?>\n");
        for (std::string line : comment_lines(job_.options.metadata)) {
            for (std::size_t at; (at = line.find("--")) != std::string::npos;)
                line.replace(at, 2, "- -");
            file_.print("<!-- {} -->\n", line);
        }
        file_.text("<scene version=\"3.0.0\">\n    <integrator type=\"path\">\n        <integer "
                   "name=\"max_depth\" value=\"6\"/>\n    </integrator>\n");
        camera();
        lights();
        for (std::size_t i = 0; i < renderer_.looks().size(); ++i)
            look(i);
        for (const SceneId id : renderer_.groups().meshes) {
            if (!file_.ok()) return file_.status();
            if (job_.cancel.raised()) return Status::failure("interrupted");
            mesh(id);
        }
        for (const MeshPlace& place : renderer_.places())
            instance(place);
        file_.text("</scene>\n");
        packed_.finish();
        return pictures_.status();
    }

    PictureCopies& pictures() { return pictures_; }

  private:
    void camera() {
        const View& view = job_.view;
        const Camera& eye = view.camera;
        file_.print("    <sensor type=\"{}\">\n", eye.orthographic ? "orthographic" : "perspective");
        if (!eye.orthographic)
            file_.print("        <string name=\"fov_axis\" value=\"x\"/>\n        <float name=\"fov\" "
                        "value=\"{}\"/>\n",
                        shortest(eye.angle_deg));
        file_.text("        <transform name=\"to_world\">\n");
        if (eye.orthographic)
            file_.print("            <scale x=\"{0}\" y=\"{0}\"/>\n", shortest(0.5 * eye.width));
        file_.print("            <lookat origin=\"{}\" target=\"{}\" up=\"{}\"/>\n        </transform>\n",
                    xml_vector(eye.location), xml_vector(eye.location + eye.direction), xml_vector(eye.up));
        file_.print("        <film type=\"hdrfilm\">\n            <integer name=\"width\" value=\"{}\"/>\n"
                    "            <integer name=\"height\" value=\"{}\"/>\n        </film>\n"
                    "        <sampler type=\"independent\">\n            <integer name=\"sample_count\" "
                    "value=\"64\"/>\n        </sampler>\n    </sensor>\n",
                    view.size.width, view.size.height);
    }

    void rgb(int blanks, std::string_view name, Rgb colour) {
        file_.print("{:{}}<rgb name=\"{}\" value=\"{}\"/>\n", "", blanks, name, xml_vector(colour));
    }

    void lights() {
        for (const Light& light : job_.view.lights) {
            const Rgb one = std::numbers::pi * light.rgb;
            if (light.sun) {
                file_.print(
                    "    <emitter type=\"directional\">\n        <vector name=\"direction\" value=\"{}\"/>\n",
                    xml_vector(-light.location));
                rgb(8, "irradiance", one);
                file_.text("    </emitter>\n");
            } else if (light.is_area()) {
                const Vec3 facing = glm::normalize(glm::cross(light.a, light.b));
                file_.print(
                    "    <shape type=\"{}\">\n        <transform name=\"to_world\">\n            <matrix "
                    "value=\"{}\"/>\n        </transform>\n        <emitter type=\"area\">\n",
                    light.round ? "disk" : "rectangle",
                    matrix({Mat3(light.a, light.b, facing), light.location}));
                rgb(12, "radiance", light.rgb);
                file_.text("        </emitter>\n    </shape>\n");
            } else {
                file_.print("    <emitter type=\"point\">\n        <point name=\"position\" value=\"{}\"/>\n",
                            xml_vector(light.location));
                rgb(8, "intensity", lamp_at_model(renderer_.scene(), light) * one);
                file_.text("    </emitter>\n");
            }
        }
        if (!job_.view.sky_light) return;
        file_.text("    <emitter type=\"constant\">\n");
        rgb(8, "radiance", job_.view.sky_light->average());
        file_.text("    </emitter>\n");
    }

    void look(std::size_t number) {
        const RendererLook& look = renderer_.looks()[number];
        const Material material = look.material ? renderer_.scene().materials[*look.material] : Material();
        const PbrMaterial pbr = pbr_of(material);
        const double alpha = pbr.roughness * pbr.roughness;
        const std::string id = fmt::format("look_{}", number);
        if (pbr.transmission > 0) {
            file_.print("    <bsdf type=\"{}\" id=\"{}\">\n        <float name=\"int_ior\" value=\"{}\"/>\n",
                        alpha > 1e-3 ? "roughdielectric" : "dielectric", id, shortest(pbr.ior));
            if (alpha > 1e-3) file_.print("        <float name=\"alpha\" value=\"{}\"/>\n", shortest(alpha));
            file_.text("    </bsdf>\n");
            return;
        }
        const bool plastic = material.specular > 0 && look.material && pbr.metallic <= 0.5;
        const char* const kind = pbr.metallic > 0.5 ? "roughconductor" : plastic ? "roughplastic" : "diffuse";
        const char* const colour = pbr.metallic > 0.5 ? "specular_reflectance"
                                   : plastic          ? "diffuse_reflectance"
                                                      : "reflectance";
        const std::string picture = look.pictured ? pictures_.name(*look.material) : "";
        if (look.pictured && material.coverage < 1) {
            file_.print(
                "    <bsdf type=\"mask\" id=\"{}\">\n        <texture type=\"bitmap\" name=\"opacity\">\n"
                "            <string name=\"filename\" value=\"{}\"/>\n        </texture>\n",
                id, xml_text(picture));
            file_.text("        <bsdf type=\"twosided\">\n");
        } else if (pbr.opacity < 1) {
            file_.print(
                "    <bsdf type=\"mask\" id=\"{}\">\n        <float name=\"opacity\" value=\"{}\"/>\n", id,
                shortest(pbr.opacity));
            file_.text("        <bsdf type=\"twosided\">\n");
        } else {
            file_.print("    <bsdf type=\"twosided\" id=\"{}\">\n", id);
        }
        file_.print("        <bsdf type=\"{}\">\n", kind);
        if (look.pictured)
            file_.print("            <texture type=\"bitmap\" name=\"{}\">\n                <string "
                        "name=\"filename\" value=\"{}\"/>\n            </texture>\n",
                        colour, xml_text(picture));
        else
            rgb(12, colour, look.colour);
        if (plastic || pbr.metallic > 0.5)
            file_.print("            <float name=\"alpha\" value=\"{}\"/>\n",
                        shortest(std::max(alpha, 1e-3)));
        file_.text("        </bsdf>\n");
        if (look.pictured || pbr.opacity < 1) file_.text("        </bsdf>\n");
        file_.text("    </bsdf>\n");
    }

    void mesh(SceneId id) {
        file_.print("    <shape type=\"shapegroup\" id=\"mesh_{}\">\n", id);
        for (const GroupSurface& surface : renderer_.surfaces(id, meshes_)) {
            const std::size_t number = packed_.add(renderer_.scene().nodes[id].name, surface);
            const std::size_t look = renderer_.look_of(surface);
            file_.print("        <shape type=\"serialized\">\n            <string name=\"filename\" "
                        "value=\"{}\"/>\n            <integer name=\"shape_index\" value=\"{}\"/>\n"
                        "            <ref id=\"look_{}\"/>\n        </shape>\n",
                        xml_text(meshes_name_), number, look);
        }
        file_.text("    </shape>\n");
    }

    static std::string matrix(const Affine& map) {
        std::string text;
        for (int row = 0; row < 3; ++row)
            text += fmt::format("{} {} {} {}  ", shortest(map.linear[0][row]), shortest(map.linear[1][row]),
                                shortest(map.linear[2][row]), shortest(map.translation[row]));
        return text + "0 0 0 1";
    }

    void instance(const MeshPlace& place) {
        file_.print(
            "    <shape type=\"instance\">\n        <ref id=\"mesh_{}\"/>\n        <transform "
            "name=\"to_world\">\n            <matrix value=\"{}\"/>\n        </transform>\n    </shape>\n",
            place.mesh, matrix(place.world_from_mesh));
    }

    const ExportJob& job_;
    const RendererScene& renderer_;
    OutputFile& file_;
    SerializedMeshes packed_;
    std::string meshes_name_;
    ShapeMeshes meshes_;
    PictureCopies pictures_;
};

Status write_mitsuba(const ExportJob& job, ExportReport& report) {
    if (refuse_range(job, 1)) return {};
    const std::optional<RendererScene> renderer =
        RendererScene::make(job, mitsuba_triangle_bytes, mitsuba_place_bytes);
    if (!renderer) return {};
    const std::filesystem::path path = job.options.output;
    std::filesystem::path meshes_path = path;
    meshes_path.replace_extension(".serialized");
    OutputFile file(path.string(), job.options.most_bytes, job.too_large);
    OutputFile meshes(meshes_path.string(), job.options.most_bytes, job.too_large);
    for (const OutputFile* const output : {&file, &meshes})
        if (!output->ok()) return output->status();
    MitsubaWriter writer(job, *renderer, file, meshes, meshes_path.filename().string());
    Status status = writer.write();
    for (OutputFile* const output : {&meshes, &file})
        if (status.ok()) status = output->close();
    if (!status.ok()) return status;
    report.summary = renderer->summary();
    return writer.pictures().commit({&meshes.pending(), &file.pending()});
}

} // namespace

const ExportFormat mitsuba_format = {
    .extension = ".xml",
    .name = "Mitsuba 3",
    .summary = "the same for Mitsuba; the meshes are in a .serialized file beside it",
    .meshes = SceneMeshes::by_size,
    .has_parts = true,
    .write = write_mitsuba,
};

} // namespace graftal
