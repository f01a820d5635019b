// pbrt-v4: shared meshes, and one level of instances.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include <glm/geometric.hpp>

#include "compiler/support/number.h"
#include "runtime/export/formats/flat_files.h"
#include "runtime/export/formats/pbr.h"
#include "runtime/export/formats/renderer_scene.h"

namespace graftal {

namespace {

constexpr double pbrt_triangle_bytes = 70, pbrt_place_bytes = 200;

std::string pbrt_vector(Vec3 v) {
    return fmt::format("{} {} {}", shortest(v.x), shortest(v.y), shortest(v.z));
}

std::string pbrt_quoted(std::string_view text) {
    std::string quoted = "\"";
    for (const char c : text)
        quoted += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
    return quoted + "\"";
}

class PbrtWriter {
  public:
    PbrtWriter(const ExportJob& job, const RendererScene& renderer, OutputFile& file)
        : job_(job), renderer_(renderer), file_(file), meshes_(renderer.scene()), pictures_(job) {}

    Status write() {
        for (const std::string& line : comment_lines(job_.options.metadata))
            file_.print("# {}\n", line);
        camera();
        file_.text("WorldBegin\n\n");
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
        return pictures_.status();
    }

    PictureCopies& pictures() { return pictures_; }

  private:
    double opacity_of(const RendererLook& look) const {
        return look.material ? pbr_of(renderer_.scene().materials[*look.material]).opacity : 1;
    }

    bool has_holes(const RendererLook& look) const {
        return look.pictured && renderer_.scene().materials[*look.material].coverage < 1;
    }

    void camera() {
        const View& view = job_.view;
        const Camera& eye = view.camera;
        // pbrt's x goes to the left of what looks along z with y up.
        file_.print("Scale -1 1 1\nLookAt {}  {}  {}\n", pbrt_vector(eye.location),
                    pbrt_vector(eye.location + eye.direction), pbrt_vector(eye.up));
        if (eye.orthographic) {
            const double x = 0.5 * eye.width, y = x * view.size.height / view.size.width;
            file_.print("Camera \"orthographic\" \"float screenwindow\" [ {} {} {} {} ]\n", shortest(-x),
                        shortest(x), shortest(-y), shortest(y));
        } else {
            file_.print("Camera \"perspective\" \"float fov\" [ {} ]\n", shortest(shorter_angle_deg(view)));
        }
        file_.text("Sampler \"zsobol\" \"integer pixelsamples\" [ 64 ]\nIntegrator \"path\" \"integer "
                   "maxdepth\" [ 6 ]\n");
        file_.print("Film \"rgb\" \"integer xresolution\" [ {} ] \"integer yresolution\" [ {} ] \"string "
                    "filename\" [ {} ]\n\n",
                    view.size.width, view.size.height,
                    pbrt_quoted(std::filesystem::path(job_.options.output).stem().string() + ".exr"));
    }

    void lights() {
        for (const Light& light : job_.view.lights) {
            const Rgb rgb = std::numbers::pi * light.rgb;
            if (light.sun) {
                file_.print(
                    "LightSource \"distant\" \"rgb L\" [ {} ] \"point3 from\" [ {} ] \"point3 to\" [ 0 0 "
                    "0 ]\n",
                    pbrt_vector(rgb), pbrt_vector(light.location));
            } else if (light.is_area() && !light.round) {
                const Vec3 corners[] = {
                    light.location - light.a - light.b, light.location + light.a - light.b,
                    light.location - light.a + light.b, light.location + light.a + light.b};
                file_.print("AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [ {} ]\nShape "
                            "\"bilinearmesh\" \"point3 P\" [ {}  {}  {}  {} ]\nAttributeEnd\n",
                            pbrt_vector(light.rgb), pbrt_vector(corners[0]), pbrt_vector(corners[1]),
                            pbrt_vector(corners[2]), pbrt_vector(corners[3]));
            } else {
                file_.print("LightSource \"point\" \"rgb I\" [ {} ] \"point3 from\" [ {} ]\n",
                            pbrt_vector(lamp_at_model(renderer_.scene(), light) * rgb),
                            pbrt_vector(light.location));
            }
        }
        if (job_.view.sky_light)
            file_.print("LightSource \"infinite\" \"rgb L\" [ {} ]\n",
                        pbrt_vector(job_.view.sky_light->average()));
        file_.text("\n");
    }

    void look(std::size_t number) {
        const RendererLook& look = renderer_.looks()[number];
        const Material material = look.material ? renderer_.scene().materials[*look.material] : Material();
        const PbrMaterial pbr = pbr_of(material);
        std::string reflectance = fmt::format("\"rgb reflectance\" [ {} ]", pbrt_vector(look.colour));
        if (look.pictured) {
            const std::string picture = pictures_.name(*look.material);
            file_.print("Texture \"picture_{}\" \"spectrum\" \"imagemap\" \"string filename\" [ {} ]\n",
                        number, pbrt_quoted(picture));
            if (has_holes(look))
                file_.print("Texture \"alpha_{}\" \"float\" \"imagemap\" \"string filename\" [ {} ]\n",
                            number, pbrt_quoted(picture));
            reflectance = fmt::format("\"texture reflectance\" [ \"picture_{}\" ]", number);
        }
        file_.print("MakeNamedMaterial \"look_{}\" ", number);
        const double alpha = pbr.roughness * pbr.roughness;
        if (pbr.transmission > 0)
            file_.print(
                "\"string type\" [ \"dielectric\" ] \"float eta\" [ {} ] \"float roughness\" [ {} ]\n",
                shortest(pbr.ior), shortest(alpha));
        else if (pbr.metallic > 0.5)
            file_.print("\"string type\" [ \"conductor\" ] {} \"float roughness\" [ {} ]\n", reflectance,
                        shortest(alpha));
        else if (material.specular > 0 && look.material)
            file_.print("\"string type\" [ \"coateddiffuse\" ] {} \"float roughness\" [ {} ]\n", reflectance,
                        shortest(alpha));
        else
            file_.print("\"string type\" [ \"diffuse\" ] {}\n", reflectance);
    }

    void mesh(SceneId id) {
        file_.print("\nObjectBegin \"mesh_{}\"  # {}\n", id, renderer_.scene().nodes[id].name);
        for (const GroupSurface& surface : renderer_.surfaces(id, meshes_)) {
            const std::size_t look = renderer_.look_of(surface);
            file_.print("NamedMaterial \"look_{}\"\n", look);
            const bool shines =
                surface.material && renderer_.scene().materials[*surface.material].emission > 0;
            if (shines) {
                file_.text("AttributeBegin\n");
                const double emission = renderer_.scene().materials[*surface.material].emission;
                file_.print("AreaLightSource \"diffuse\" \"rgb L\" [ {} ]\n",
                            pbrt_vector(emission * renderer_.looks()[look].colour));
            }
            file_.text("Shape \"trianglemesh\" \"integer indices\" [");
            for (const auto& t : surface.triangles)
                file_.print(" {} {} {}", t[0], t[1], t[2]);
            file_.text(" ]\n  \"point3 P\" [");
            floats(surface.vertices);
            file_.text(" ]\n  \"normal N\" [");
            floats(surface.normals);
            file_.text(" ]\n");
            if (!surface.uv.empty()) {
                file_.text("  \"point2 uv\" [");
                floats(surface.uv);
                file_.text(" ]\n");
            }
            if (has_holes(renderer_.looks()[look]))
                file_.print("  \"texture alpha\" [ \"alpha_{}\" ]\n", look);
            else if (const double opacity = opacity_of(renderer_.looks()[look]); opacity < 1)
                file_.print("  \"float alpha\" [ {} ]\n", shortest(opacity));
            if (shines) file_.text("AttributeEnd\n");
        }
        file_.text("ObjectEnd\n");
    }

    template<std::size_t n> void floats(const std::vector<std::array<float, n>>& values) {
        for (const auto& value : values)
            for (const float number : value)
                file_.print(" {}", number + 0.0f);
    }

    void instance(const MeshPlace& place) {
        const Mat3& m = place.world_from_mesh.linear;
        file_.print("AttributeBegin\nConcatTransform [ {} 0  {} 0  {} 0  {} 1 ]\nObjectInstance \"mesh_{}\"\n"
                    "AttributeEnd\n",
                    pbrt_vector(m[0]), pbrt_vector(m[1]), pbrt_vector(m[2]),
                    pbrt_vector(place.world_from_mesh.translation), place.mesh);
    }

    const ExportJob& job_;
    const RendererScene& renderer_;
    OutputFile& file_;
    ShapeMeshes meshes_;
    PictureCopies pictures_;
};

Status write_pbrt(const ExportJob& job, ExportReport& report) {
    if (refuse_range(job, 1)) return {};
    const std::optional<RendererScene> renderer =
        RendererScene::make(job, pbrt_triangle_bytes, pbrt_place_bytes);
    if (!renderer) return {};
    OutputFile file(job.options.output, job.options.most_bytes, job.too_large);
    if (!file.ok()) return file.status();
    PbrtWriter writer(job, *renderer, file);
    Status status = writer.write();
    if (status.ok()) status = file.close();
    if (!status.ok()) return status;
    report.summary = renderer->summary();
    return writer.pictures().commit({&file.pending()});
}

} // namespace

const ExportFormat pbrt_format = {
    .extension = ".pbrt",
    .name = "pbrt-v4",
    .summary = "shared meshes with one level of instances, camera, lights and materials",
    .meshes = SceneMeshes::by_size,
    .has_parts = true,
    .write = write_pbrt,
};

} // namespace graftal
