// USD as text. The graph itself, nested: a node is a class prim that references the next, so that 10^30
// leaves are a few kilobytes.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <glm/geometric.hpp>

#include "compiler/support/number.h"
#include "compiler/unfolded/levels.h"
#include "compiler/unfolded/looks.h"
#include "runtime/export/formats/flat_files.h"
#include "runtime/export/formats/pbr.h"
#include "runtime/export/formats/picture_copies.h"
#include "runtime/export/formats/renderer_scene.h"
#include "runtime/export/formats/rigid_parts.h"
#include "runtime/export/formats/usd_text.h"
#include "runtime/export/united_facets.h"

namespace graftal {

namespace {

/// Least number of parts that a node lists in a PointInstancer: parts that move, turn and scale only.
constexpr std::size_t fewest_points = 64;
/// Bytes that a part takes, about, by itself and in a PointInstancer.
constexpr std::uint64_t usd_part_bytes = 250, usd_point_bytes = 150;
/// Lamps without a size are balls in USD.
constexpr double point_radius = 0.01;
constexpr std::size_t most_usd_parts = 8'000'000;
constexpr std::size_t most_usd_looks = 1'000'000;
/// Most parts wanted in a file that has few, and most wanted for each part of the graph.
constexpr std::uint64_t fewest_wanted_parts = 2000, most_times_parts = 2;

/// A name that USD takes.
std::string usd_word(std::string_view name) {
    std::string text;
    for (const char c : name.substr(0, 40))
        text += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
    if (text.empty() || std::isdigit(static_cast<unsigned char>(text[0]))) text = "n" + text;
    return text;
}

std::string vector_text(Vec3 v) {
    return fmt::format("({}, {}, {})", float_text(v.x), float_text(v.y), float_text(v.z));
}

/// Points are rows in USD.
std::string matrix_text(const Affine& map) {
    const auto row = [](Vec3 v, int w) {
        return fmt::format("({}, {}, {}, {})", shortest(v.x), shortest(v.y), shortest(v.z), w);
    };
    return fmt::format("( {}, {}, {}, {} )", row(map.linear[0], 0), row(map.linear[1], 0),
                       row(map.linear[2], 0), row(map.translation, 1));
}

class UsdWriter {
  public:
    UsdWriter(const ExportJob& job, const UnfoldedScene& scene, OutputFile& file)
        : job_(job), scene_(scene), file_(file), meshes_(scene, PicturePlaces::of_surfaces), pictures_(job) {}

    Status write() {
        head();
        std::size_t written = 0;
        materials();
        file_.text("class \"prototypes\"\n{\n");
        for (const SceneId id : scene_.masters_first) {
            if (!file_.ok()) return file_.status();
            if (++written % 1024 == 0 && job_.cancel.raised()) return Status::failure("interrupted");
            if (scene_.nodes[id].shape)
                leaf(id);
            else
                unite(id);
        }
        file_.text("}\n");
        return pictures_.status();
    }

    PictureCopies& pictures() { return pictures_; }
    std::string summary() const {
        return fmt::format("{} prototypes, {} instances, {} of them points", prototypes_, instances_,
                           points_);
    }

  private:
    void head() {
        const double metres = job_.options.unit_mm.value_or(1000) / 1000;
        file_.print("#usda 1.0\n(\n defaultPrim = \"model\"\n metersPerUnit = {}\n upAxis = \"Y\"\n",
                    shortest(metres));
        file_.text(")\n\n");
        for (const std::string& line : comment_lines(job_.options.metadata))
            file_.print("# {}\n", line);
        file_.text("\ndef Xform \"model\"\n{\n");
        if (!scene_.nodes[scene_.root].parts.empty() || scene_.nodes[scene_.root].shape) {
            file_.print(" def Xform \"root\" (\n  instanceable = true\n  prepend references = "
                        "<{}>\n )\n {{\n }}\n",
                        path(scene_.root));
            ++instances_;
        }
        camera();
        lights();
        file_.text("}\n\n");
    }

    std::string path(SceneId id) const { return "/prototypes/" + name(id); }
    /// The number tells it from all other prims.
    std::string name(SceneId id) const { return fmt::format("{}_{}", usd_word(scene_.nodes[id].name), id); }

    void placed(const Affine& place) {
        file_.print("  matrix4d xformOp:transform = {}\n", matrix_text(place));
        file_.text("  uniform token[] xformOpOrder = [\"xformOp:transform\"]\n");
    }

    /// Begins a prototype. Whoever references it says only where it lies.
    void prototype(SceneId id) {
        ++prototypes_;
        file_.print(" class Xform \"{}\"\n {{\n", name(id));
        placed({});
    }

    void instance(std::string_view name, const ScenePart& part) {
        file_.print("  def Xform \"{}\" (\n   instanceable = true\n   prepend references "
                    "= <{}>\n  )\n  {{\n",
                    name, path(part.node));
        if (part.colour)
            file_.print("   color3f[] primvars:displayColor = [{}]\n", vector_text(*part.colour));
        file_.print("   matrix4d xformOp:transform = {}\n", matrix_text(part.node_from_part));
        file_.text("  }\n");
        ++instances_;
    }

    void unite(SceneId id) {
        const SceneNode& node = scene_.nodes[id];
        prototype(id);
        std::vector<std::size_t> points;
        std::vector<MoveTurnScale> places;
        if (node.parts.size() >= fewest_points)
            for (std::size_t i = 0; i < node.parts.size(); ++i)
                if (const auto place =
                        node.parts[i].colour ? std::nullopt : move_turn_scale(node.parts[i].node_from_part)) {
                    points.push_back(i);
                    places.push_back(*place);
                }
        if (points.size() < fewest_points) points.clear();
        std::size_t next = 0;
        for (std::size_t i = 0; i < node.parts.size(); ++i) {
            if (next < points.size() && points[next] == i)
                ++next;
            else
                instance(fmt::format("p{}", i), node.parts[i]);
        }
        if (!points.empty()) instancer(id, points, places);
        file_.text(" }\n");
    }

    static constexpr std::string_view by_vertex = " (\n    interpolation = \"vertex\"\n   )";

    template<typename Text>
    void list(std::string_view declaration, std::size_t count, const Text& text,
              std::string_view after = "") {
        file_.print("   {} = [", declaration);
        for (std::size_t i = 0; i < count; ++i)
            file_.print("{}{}", i == 0 ? "" : ", ", text(i));
        file_.print("]{}\n", after);
    }

    void instancer(SceneId id, const std::vector<std::size_t>& points,
                   const std::vector<MoveTurnScale>& places) {
        const SceneNode& node = scene_.nodes[id];
        std::vector<SceneId> masters;
        std::map<SceneId, std::size_t> number_of;
        for (const std::size_t i : points)
            if (number_of.try_emplace(node.parts[i].node, masters.size()).second)
                masters.push_back(node.parts[i].node);
        file_.text("  def PointInstancer \"points\"\n  {\n");
        list("rel prototypes", masters.size(),
             [&](std::size_t i) { return fmt::format("<{}/points/m{}>", path(id), i); });
        list("int[] protoIndices", points.size(),
             [&](std::size_t i) { return fmt::to_string(number_of.at(node.parts[points[i]].node)); });
        list("point3f[] positions", points.size(),
             [&](std::size_t i) { return vector_text(places[i].move); });
        const auto turn = [&](std::size_t i) {
            const glm::dquat& q = places[i].turn;
            return fmt::format("({}, {}, {}, {})", float_text(q.w), float_text(q.x), float_text(q.y),
                               float_text(q.z));
        };
        // Halves are what all readers know, and floats are what turns need.
        list("quath[] orientations", points.size(), turn);
        list("quatf[] orientationsf", points.size(), turn);
        list("float3[] scales", points.size(), [&](std::size_t i) { return vector_text(places[i].scale); });
        for (std::size_t i = 0; i < masters.size(); ++i) {
            file_.print("   def Xform \"m{}\" (\n    instanceable = true\n    "
                        "prepend references = <{}>\n   )\n   {{\n   }}\n",
                        i, path(masters[i]));
        }
        file_.text("  }\n");
        points_ += points.size();
        instances_ += points.size();
    }

    void leaf(SceneId id) {
        const SceneNode& node = scene_.nodes[id];
        const ShapeMesh& mesh = meshes_.of(*node.shape, node.look);
        prototype(id);
        file_.text("  def Mesh \"mesh\"");
        // Looks of one shape share its mesh.
        const auto [known, is_new] = mesh_of_.try_emplace(&mesh, id);
        if (is_new) {
            file_.text(" (\n   prepend apiSchemas = [\"MaterialBindingAPI\"]\n  )\n  {\n");
            mesh_text(mesh);
        } else {
            file_.print(" (\n   prepend apiSchemas = [\"MaterialBindingAPI\"]\n   prepend "
                        "references = <{}/mesh>\n  )\n  {{\n",
                        path(known->second));
        }
        if (!node.look.colourless)
            file_.print("   color3f[] primvars:displayColor = [{}]\n", vector_text(node.look.colour()));
        const bool has_material = node.look.material.has_value();
        if (has_material)
            file_.print("   rel material:binding = <{}/{}>\n", path(id), material_name(*node.look.material));
        file_.text("  }\n");
        if (has_material) look(id, *node.look.material, node.look);
        file_.text(" }\n");
    }

    void mesh_text(const ShapeMesh& mesh) {
        Box box;
        for (const Vec3& vertex : mesh.vertices)
            box.include(vertex);
        file_.text("   uniform bool doubleSided = 1\n");
        file_.print("   float3[] extent = [{}, {}]\n", vector_text(box.min), vector_text(box.max));
        list("int[] faceVertexCounts", mesh.triangles.size(), [](std::size_t) { return "3"; });
        list("int[] faceVertexIndices", 3 * mesh.triangles.size(),
             [&](std::size_t i) { return fmt::to_string(mesh.triangles[i / 3][i % 3]); });
        list("point3f[] points", mesh.vertices.size(),
             [&](std::size_t i) { return vector_text(mesh.vertices[i]); });
        list(
            "normal3f[] normals", mesh.normals.size(),
            [&](std::size_t i) { return vector_text(mesh.normals[i]); }, by_vertex);
        if (!mesh.uv.empty()) {
            list(
                "texCoord2f[] primvars:st", mesh.uv.size(),
                [&](std::size_t i) {
                    return fmt::format("({}, {})", float_text(mesh.uv[i][0]), float_text(mesh.uv[i][1]));
                },
                by_vertex);
        }
        file_.text("   uniform token subdivisionScheme = \"none\"\n");
    }

    /// The model's materials by their names, each once: looks reference them.
    void materials() {
        std::set<MaterialId> used;
        for (const SceneId id : scene_.masters_first)
            if (scene_.nodes[id].shape && scene_.nodes[id].look.material)
                used.insert(*scene_.nodes[id].look.material);
        file_.text("def Scope \"materials\"\n{\n");
        for (const MaterialId number : used)
            material(number);
        file_.text("}\n\n");
    }

    /// Names of materials differ in the model, but perhaps not as USD spells them.
    const std::string& material_name(MaterialId number) {
        const auto [known, is_new] = material_names_.try_emplace(number);
        if (!is_new) return known->second;
        std::string name = usd_word(scene_.materials[number].name);
        while (!known_names_.insert(name).second)
            name += '_';
        return known->second = name;
    }

    void material(MaterialId number) {
        const Material& material = scene_.materials[number];
        const PbrMaterial look = pbr_of(material);
        const std::string& name = material_name(number);
        const std::string here = "/materials/" + name;
        const bool pictured = !material.texture.empty();
        file_.print(" def Material \"{}\"\n {{\n  token outputs:surface.connect = "
                    "<{}/surface.outputs:surface>\n  def Shader \"surface\"\n  {{\n",
                    name, here);
        const auto line = [&](const std::string& text) { file_.print("   {}\n", text); };
        line("uniform token info:id = \"UsdPreviewSurface\"");
        if (pictured) {
            line(fmt::format("color3f inputs:diffuseColor.connect = <{}/picture.outputs:rgb>", here));
            if (material.coverage < 1) {
                line(fmt::format("float inputs:opacity.connect = <{}/picture.outputs:a>", here));
                line("float inputs:opacityThreshold = 0.5");
            }
        } else {
            line("color3f inputs:diffuseColor = " + vector_text(material.rgb));
            const double opacity = look.opacity - look.transmission; // one of them says something
            if (opacity < 1) line("float inputs:opacity = " + float_text(opacity));
        }
        line("float inputs:metallic = " + float_text(look.metallic));
        line("float inputs:roughness = " + float_text(look.roughness));
        line("float inputs:ior = " + float_text(look.ior));
        if (look.emission > 0)
            line("color3f inputs:emissiveColor = " + vector_text(look.emission * material.rgb));
        line("token outputs:surface");
        file_.text("  }\n");
        if (pictured) {
            file_.print("  def Shader \"place\"\n  {{\n   uniform token info:id "
                        "= \"UsdPrimvarReader_float2\"\n   string inputs:varname = \"st\"\n"
                        "   float2 outputs:result\n  }}\n"
                        "  def Shader \"picture\"\n  {{\n   uniform token "
                        "info:id = \"UsdUVTexture\"\n   asset inputs:file = {}\n"
                        "   token inputs:wrapS = \"repeat\"\n   token inputs:wrapT = "
                        "\"repeat\"\n   float2 inputs:st.connect = <{}/place.outputs:result>\n"
                        "   float3 outputs:rgb\n   float outputs:a\n  }}\n",
                        usd_asset(pictures_.name(number)), here);
        }
        file_.text(" }\n");
    }

    /// A material within a prototype: the model's, except for a colour of its own. A prototype binds nothing
    /// outside itself.
    void look(SceneId id, MaterialId number, const SceneLook& shown) {
        const Material& material = scene_.materials[number];
        const std::string& name = material_name(number);
        const std::string here = path(id) + "/" + name;
        file_.print("  def Material \"{0}\" (\n   prepend references = </materials/{0}>\n  )\n  {{\n", name);
        const Rgb colour = shown.colour();
        if (material.texture.empty() && (shown.colourless || colour != material.rgb)) {
            file_.text("   over \"surface\"\n   {\n");
            if (shown.colourless)
                file_.print("    color3f inputs:diffuseColor.connect = <{}/colour.outputs:result>\n", here);
            else
                file_.print("    color3f inputs:diffuseColor = {}\n", vector_text(colour));
            const double emission = pbr_of(material).emission;
            if (emission > 0)
                file_.print("    color3f inputs:emissiveColor = {}\n", vector_text(emission * colour));
            file_.text("   }\n");
            if (shown.colourless)
                file_.text("   def Shader \"colour\"\n   {\n    uniform token info:id "
                           "= \"UsdPrimvarReader_float3\"\n    string inputs:varname = "
                           "\"displayColor\"\n    float3 outputs:result\n   }\n");
        }
        file_.text("  }\n");
    }

    void camera() {
        const View& view = job_.view;
        const Camera& eye = view.camera;
        constexpr double film_mm = 36;
        const double aspect = static_cast<double>(view.size.width) / view.size.height;
        const double radius = scene_.bounds.empty() ? 1 : 0.5 * glm::length(scene_.bounds.size());
        const double away = scene_.bounds.empty() ? 1 : glm::length(scene_.bounds.centre() - eye.location);
        file_.text(" def Camera \"camera\"\n {\n");
        const double width = eye.orthographic ? 10 * eye.width : film_mm;
        const double focal = eye.orthographic
                                 ? film_mm
                                 : 0.5 * film_mm / std::tan(0.5 * eye.angle_deg * std::numbers::pi / 180);
        file_.print("  token projection = \"{}\"\n", eye.orthographic ? "orthographic" : "perspective");
        file_.print("  float focalLength = {}\n  float horizontalAperture = {}\n  float "
                    "verticalAperture = {}\n",
                    float_text(focal), float_text(width), float_text(width / aspect));
        file_.print("  float2 clippingRange = ({}, {})\n", float_text(1e-3 * (away + radius)),
                    float_text(4 * (away + radius)));
        placed({Mat3(eye.right, eye.up, -eye.direction), eye.location});
        file_.text(" }\n");
    }

    void lights() {
        std::size_t number = 0;
        for (const Light& light : job_.view.lights) {
            const char* kind = light.sun         ? "DistantLight"
                               : light.round     ? "DiskLight"
                               : light.is_area() ? "RectLight"
                                                 : "SphereLight";
            file_.print(" def {} \"light_{}\"\n {{\n", kind, number++);
            file_.print("  color3f inputs:color = {}\n", vector_text(light.rgb));
            file_.print("  float inputs:intensity = {}\n", float_text(intensity_of(light)));
            if (light.sun)
                file_.print("  float inputs:angle = {}\n  bool inputs:normalize = 1\n",
                            float_text(light.angle_deg));
            if (light.is_area() && light.round)
                file_.print("  float inputs:radius = {}\n", float_text(glm::length(light.a)));
            if (light.is_area() && !light.round)
                file_.print("  float inputs:width = {}\n  float inputs:height = {}\n",
                            float_text(2 * glm::length(light.a)), float_text(2 * glm::length(light.b)));
            if (!light.sun && !light.is_area())
                file_.print("  float inputs:radius = {}\n  bool treatAsPoint = 1\n",
                            float_text(point_radius));
            // Light goes along -z.
            Vec3 back(0, 0, 1);
            if (light.sun)
                back = glm::normalize(light.location);
            else if (light.is_area())
                back = -glm::normalize(glm::cross(light.a, light.b));
            const Vec3 aside = std::abs(back.y) < 0.9 ? Vec3(0, 1, 0) : Vec3(1, 0, 0);
            const Vec3 right =
                light.is_area() ? glm::normalize(light.a) : glm::normalize(glm::cross(aside, back));
            placed({Mat3(right, glm::cross(back, right), back), light.sun ? Vec3(0.0) : light.location});
            file_.text(" }\n");
        }
        if (job_.view.sky_light) dome(*job_.view.sky_light);
    }

    /// The intensity by which white paper that faces the light shows its colour, as far as the middle of the
    /// model. A sun of this schema has the irradiance of its intensity, others a radiance.
    double intensity_of(const Light& light) const {
        constexpr double pi = std::numbers::pi;
        if (light.sun) return pi;
        const double sides = glm::length(light.a) * glm::length(light.b);
        const double area = !light.is_area() ? pi * point_radius * point_radius
                            : light.round    ? pi * sides
                                             : 4 * sides;
        return pi * lamp_at_model(scene_, light) / area;
    }

    /// The middle of a picture lies towards +z in USD, and its right towards -x.
    void dome(const SkyLight& sky) {
        file_.text(" def DomeLight \"sky\"\n {\n  float inputs:intensity = 1\n");
        if (!sky.picture) {
            file_.print("  color3f inputs:color = {}\n }}\n", vector_text(sky.average()));
            return;
        }
        file_.print("  color3f inputs:color = {}\n  asset inputs:texture:file = {}\n  token "
                    "inputs:texture:format = \"latlong\"\n",
                    vector_text(Vec3(sky.brightness)), usd_asset(pictures_.sky(*sky.picture)));
        const Mat3 picture_from_dome(Vec3(0, 0, -1), Vec3(0, 1, 0), Vec3(1, 0, 0));
        placed({glm::transpose(sky.picture_from_world) * picture_from_dome, Vec3(0.0)});
        file_.text(" }\n");
    }

    const ExportJob& job_;
    const UnfoldedScene& scene_;
    OutputFile& file_;
    ShapeMeshes meshes_;
    PictureCopies pictures_;
    std::map<const ShapeMesh*, SceneId> mesh_of_;
    std::map<MaterialId, std::string> material_names_;
    /// Names that materials may not have: theirs, and of what stands beside them in a prototype.
    std::set<std::string> known_names_{"mesh"};
    std::size_t prototypes_ = 0, instances_ = 0, points_ = 0;
};

bool refuse_usd_size(const ExportJob& job, const UnfoldedScene& scene) {
    std::uint64_t bytes = 0;
    for (const SceneId id : scene.masters_first) {
        const std::size_t parts = scene.nodes[id].parts.size();
        bytes += parts * (parts >= fewest_points ? usd_point_bytes : usd_part_bytes);
    }
    if (bytes <= job.options.most_bytes) return false;
    refuse_as_too_large(job,
                        fmt::format("'{}' would have {} instances, about {:.3g} bytes", job.options.output,
                                    count(scene).parts, static_cast<double>(bytes)),
                        "allow it with --limit, or leave out more with a larger --error or fewer --steps");
    return true;
}

Status write_usd(const ExportJob& job, ExportReport& report) {
    if (refuse_range(job, 1)) return {};
    // Tints shall not make the file much larger than the graph is.
    const std::uint64_t wanted = std::max(fewest_wanted_parts, most_times_parts * count(job.scene).parts);
    std::optional<UnfoldedScene> scene =
        resolve_looks(job.scene, {most_usd_looks, wanted, TintsOn::instances}, job.model, job.diagnostics);
    job.too_large = !scene;
    if (!scene) return {};
    unite_facets(*scene);
    if (job.options.levels) {
        // The file's root places the model's.
        scene = with_levels(*scene, std::max(*job.options.levels, 2u) - 1, most_usd_parts);
        if (!scene) {
            refuse_as_too_large(
                job,
                fmt::format("with {} levels of instances, '{}' would have more than {} parts",
                            *job.options.levels, job.options.output, most_usd_parts),
                "allow more --levels, or leave out more with a larger --error or fewer --steps");
            return {};
        }
    }
    if (refuse_usd_size(job, *scene)) return {};
    OutputFile file(job.options.output, job.options.most_bytes, job.too_large);
    if (!file.ok()) return file.status();
    UsdWriter writer(job, *scene, file);
    Status status = writer.write();
    if (status.ok()) status = file.close();
    if (!status.ok()) return status;
    report.summary = fmt::format("{}, at most {} levels", writer.summary(), count(*scene).depth + 1);
    return writer.pictures().commit({&file.pending()});
}

} // namespace

const ExportFormat usd_format = {
    .extension = ".usda",
    .name = "USD",
    .summary = "instances within instances, as the model has them",
    .has_unit = true,
    .has_levels = true,
    .write = write_usd,
};

} // namespace graftal
