// glTF 2.0 and its binary form, by tinygltf. Meshes are shared, unions are not: each place is a node.

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <ostream>
#include <streambuf>

#include "compiler/unfolded/looks.h"
#include "runtime/export/formats/flat_files.h"
#include "runtime/export/formats/gltf_buffer.h"
#include "runtime/export/formats/group_mesh.h"
#include "runtime/export/formats/pbr.h"
#include "runtime/export/formats/picture_copies.h"
#include "runtime/export/formats/rigid_parts.h"
#include "runtime/export/held_parts.h"

namespace graftal {

namespace {

using GltfObject = tinygltf::Value::Object;

/// A node that is one of many places costs a line of a table, no node.
constexpr double triangles_of_gltf_node = 100, triangles_of_instance = 2;
constexpr double most_gltf_instances = 2e6;
/// Lights shine over a half sphere: what POV-Ray calls 1 is pi times as much to a surface.
constexpr double light_of_one = std::numbers::pi;

/// A stream for a library that writes into a file.
class FileStream : public std::streambuf {
  public:
    explicit FileStream(OutputFile& file) : file_(file) {}

  protected:
    std::streamsize xsputn(const char* bytes, std::streamsize count) override {
        file_.text({bytes, static_cast<std::size_t>(count)});
        return file_.ok() ? count : 0;
    }
    int_type overflow(int_type byte) override {
        if (byte != traits_type::eof()) file_.byte(static_cast<std::uint8_t>(byte));
        return file_.ok() ? traits_type::not_eof(byte) : traits_type::eof();
    }

  private:
    OutputFile& file_;
};

class GltfWriter {
  public:
    GltfWriter(const ExportJob& job, const UnfoldedScene& scene, std::vector<bool> held)
        : job_(job), scene_(scene), held_(std::move(held)), meshes_(scene, PicturePlaces::of_surfaces),
          pictures_(job) {
        model_.asset.version = "2.0";
        model_.asset.generator = job.options.metadata.software;
        model_.buffers.emplace_back();
    }

    Status make() {
        GroupOptions options;
        options.most_nodes = static_cast<double>(job_.options.nodes.value_or(ExportOptions::default_nodes));
        options.triangles_of_node = triangles_of_gltf_node;
        if (job_.options.instancing) {
            options.most_nodes = most_gltf_instances;
            options.triangles_of_node = triangles_of_instance;
        }
        options.held = std::move(held_);
        groups_ = group_meshes(scene_, options);
        if (refuse_groups(options.most_nodes)) return {};
        for (const SceneId id : groups_.meshes) {
            add_mesh(id);
            if (job_.cancel.raised()) return Status::failure("interrupted");
        }
        const double metres = job_.options.unit_mm.value_or(1000) / 1000;
        tinygltf::Node world;
        world.name = scene_.nodes[scene_.root].name;
        if (metres != 1) world.scale = {metres, metres, metres};
        const int root = add_node(std::move(world));
        if (job_.options.instancing)
            add_instances(root);
        else
            add_tree(root);
        add_camera(metres);
        add_lights(metres);
        model_.scenes.emplace_back().nodes = top_;
        model_.defaultScene = 0;
        return pictures_.status();
    }

    void write(OutputFile& file, bool binary) {
        if (model_.buffers[0].data.empty()) model_.buffers.clear();
        FileStream buffer(file);
        std::ostream stream(&buffer);
        tinygltf::TinyGLTF().WriteGltfSceneToStream(&model_, stream, !binary, binary);
    }

    std::string summary() const {
        return fmt::format("{} meshes of {:.0f} triangles, {} nodes", model_.meshes.size(), groups_.triangles,
                           model_.nodes.size());
    }

  private:
    /// About: with the corners, normals and colours that it has for itself.
    static constexpr double bytes_of_triangle = 60;
    /// In memory, for each byte of the file.
    static constexpr double copies_in_memory = 4;

    bool refuse_groups(double most_nodes) const {
        if (groups_.nodes > most_nodes) {
            refuse_as_too_large(
                job_,
                fmt::format("with each --part by itself, '{}' would have {:.3g} nodes, more than {:.0f}",
                            job_.options.output, groups_.nodes, most_nodes),
                "allow more with --nodes, or tables of places with --instancing; or leave out more with a "
                "larger --error");
            return true;
        }
        const double bytes = groups_.triangles * bytes_of_triangle;
        const auto most = static_cast<double>(job_.options.most_bytes);
        const bool fits = bytes <= most;
        if (fits && bytes * copies_in_memory <= static_cast<double>(job_.options.memory_bytes)) return false;
        refuse_as_too_large(
            job_,
            fmt::format("with {:.0f} nodes, '{}' would have meshes of {:.3g} triangles, about {:.3g} "
                        "bytes",
                        groups_.nodes, job_.options.output, groups_.triangles, bytes),
            fmt::format("allow more nodes with --nodes, {} with {}, or tables of places with "
                        "--instancing; leave out more with a larger --error or fewer --steps; or "
                        "choose .usda, which nests parts",
                        fits ? "more memory" : "a larger file", fits ? "--memory" : "--limit"));
        return true;
    }

    int add_node(tinygltf::Node node) {
        const int id = add_to(model_.nodes, std::move(node));
        if (id == 0) top_.push_back(id);
        return id;
    }

    int add_child(int parent, tinygltf::Node node) {
        const int id = add_node(std::move(node));
        model_.nodes[static_cast<std::size_t>(parent)].children.push_back(id);
        return id;
    }

    static void place(tinygltf::Node& node, const MoveTurnScale& at) {
        if (at.move != Vec3(0.0)) node.translation = {at.move.x, at.move.y, at.move.z};
        if (std::abs(at.turn.w) < 1 - 1e-15) node.rotation = {at.turn.x, at.turn.y, at.turn.z, at.turn.w};
        if (at.scale != Vec3(1.0)) node.scale = {at.scale.x, at.scale.y, at.scale.z};
    }

    /// A node within another, or two where the map shears.
    int add_placed(int parent, tinygltf::Node node, const Affine& map) {
        if (const auto one = move_turn_scale(map)) {
            place(node, *one);
            return add_child(parent, std::move(node));
        }
        const std::array<MoveTurnScale, 2> two = two_moves(map);
        tinygltf::Node outer;
        outer.name = node.name;
        place(outer, two[0]);
        place(node, two[1]);
        const int id = add_child(parent, std::move(outer));
        return add_child(id, std::move(node));
    }

    void add_tree(int root) {
        struct Waiting {
            SceneId node;
            int gltf;
        };
        if (groups_.is_mesh[scene_.root]) {
            model_.nodes[static_cast<std::size_t>(root)].mesh = mesh_of(scene_.root);
            return;
        }
        std::vector<Waiting> waiting{{scene_.root, root}};
        while (!waiting.empty()) {
            const Waiting at = waiting.back();
            waiting.pop_back();
            for (const ScenePart& part : scene_.nodes[at.node].parts) {
                const bool is_mesh = groups_.is_mesh[part.node];
                if (!is_mesh && scene_.nodes[part.node].parts.empty()) continue;
                if (is_mesh && mesh_of(part.node) < 0) continue;
                tinygltf::Node node;
                node.name = scene_.nodes[part.node].name;
                if (is_mesh) node.mesh = mesh_of(part.node);
                const int id = add_placed(at.gltf, std::move(node), part.node_from_part);
                if (!is_mesh) waiting.push_back({part.node, id});
            }
        }
    }

    /// One node a mesh, with a table of its places; what is sheared has nodes of its own.
    void add_instances(int root) {
        std::map<SceneId, std::vector<MoveTurnScale>> places;
        for (const MeshPlace& at : places_of(scene_, groups_)) {
            if (mesh_of(at.mesh) < 0) continue;
            if (const auto one = move_turn_scale(at.world_from_mesh)) {
                places[at.mesh].push_back(*one);
                continue;
            }
            tinygltf::Node node;
            node.name = scene_.nodes[at.mesh].name;
            node.mesh = mesh_of(at.mesh);
            add_placed(root, std::move(node), at.world_from_mesh);
        }
        for (const auto& [id, list] : places) {
            std::vector<std::array<float, 3>> moves, scales;
            std::vector<std::array<float, 4>> turns;
            for (const MoveTurnScale& at : list) {
                const glm::vec3 move(at.move), scale(at.scale);
                const glm::quat turn(at.turn);
                moves.push_back({move.x, move.y, move.z});
                turns.push_back({turn.x, turn.y, turn.z, turn.w});
                scales.push_back({scale.x, scale.y, scale.z});
            }
            GltfObject attributes;
            attributes["TRANSLATION"] = tinygltf::Value(add_vectors(model_, moves, 0));
            attributes["ROTATION"] = tinygltf::Value(add_vectors(model_, turns, 0));
            attributes["SCALE"] = tinygltf::Value(add_vectors(model_, scales, 0));
            tinygltf::Node node;
            node.name = scene_.nodes[id].name;
            node.mesh = mesh_of(id);
            extend(node.extensions, "EXT_mesh_gpu_instancing", {{"attributes", tinygltf::Value(attributes)}});
            model_.extensionsRequired = {"EXT_mesh_gpu_instancing"};
            add_child(root, std::move(node));
        }
    }

    void extend(tinygltf::ExtensionMap& extensions, const std::string& name, GltfObject values) {
        extensions[name] = tinygltf::Value(std::move(values));
        std::vector<std::string>& used = model_.extensionsUsed;
        if (std::ranges::find(used, name) == used.end()) used.push_back(name);
    }

    int mesh_of(SceneId id) const {
        const auto known = mesh_of_.find(id);
        return known == mesh_of_.end() ? -1 : known->second;
    }

    void add_mesh(SceneId id) {
        tinygltf::Mesh mesh;
        mesh.name = scene_.nodes[id].name;
        for (const GroupSurface& surface : surfaces_of(scene_, id, meshes_))
            mesh.primitives.push_back(primitive_of(surface));
        if (mesh.primitives.empty()) return; // nothing of it is left in 32 bits
        mesh_of_[id] = add_to(model_.meshes, std::move(mesh));
    }

    tinygltf::Primitive primitive_of(const GroupSurface& surface) {
        tinygltf::Primitive primitive;
        primitive.mode = TINYGLTF_MODE_TRIANGLES;
        const int positions = add_vectors(model_, surface.vertices);
        std::array<float, 3> low = surface.vertices.front(), high = low;
        for (const auto& v : surface.vertices)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                low[axis] = std::min(low[axis], v[axis]);
                high[axis] = std::max(high[axis], v[axis]);
            }
        tinygltf::Accessor& bounds = model_.accessors[static_cast<std::size_t>(positions)];
        bounds.minValues.assign(low.begin(), low.end());
        bounds.maxValues.assign(high.begin(), high.end());
        primitive.attributes["POSITION"] = positions;
        primitive.attributes["NORMAL"] = add_vectors(model_, surface.normals);
        if (!surface.uv.empty()) {
            std::vector<std::array<float, 2>> uv = surface.uv; // v downwards
            for (auto& point : uv)
                point[1] = 1 - point[1];
            primitive.attributes["TEXCOORD_0"] = add_vectors(model_, uv);
        }
        if (surface.coloured) primitive.attributes["COLOR_0"] = add_colours(model_, surface.colours);
        primitive.indices = add_corners(model_, surface.triangles, surface.vertices.size());
        primitive.material = material_of(surface);
        return primitive;
    }

    int material_of(const GroupSurface& surface) {
        const std::int64_t number = surface.material ? static_cast<std::int64_t>(*surface.material) : -1;
        const auto [known, is_new] =
            material_of_.try_emplace({number, surface.coloured}, static_cast<int>(model_.materials.size()));
        if (!is_new) return known->second;
        tinygltf::Material made;
        made.name = surface.material ? scene_.materials[*surface.material].name : "default";
        if (surface.coloured) made.name += "_tinted";
        made.doubleSided = true;
        const Rgb plain = surface.coloured ? Rgb(1.0) : plain_colour(scene_, surface.material);
        auto& pbr = made.pbrMetallicRoughness;
        pbr.baseColorFactor = {plain.r, plain.g, plain.b, 1};
        const Material material = surface.material ? scene_.materials[*surface.material] : Material();
        const PbrMaterial look = pbr_of(material);
        if (look.opacity < 1) {
            pbr.baseColorFactor[3] = look.opacity;
            made.alphaMode = "BLEND";
        }
        pbr.metallicFactor = look.metallic;
        pbr.roughnessFactor = look.roughness;
        if (look.emission > 0) {
            const Rgb light = look.emission * material.rgb;
            const double most = std::max({light.r, light.g, light.b, 1.0});
            made.emissiveFactor = {light.r / most, light.g / most, light.b / most};
            if (most > 1)
                extend(made.extensions, "KHR_materials_emissive_strength",
                       {{"emissiveStrength", tinygltf::Value(most)}});
        }
        if (look.transmission > 0)
            extend(made.extensions, "KHR_materials_transmission",
                   {{"transmissionFactor", tinygltf::Value(look.transmission)}});
        if (look.transmission > 0 || material.has_coat())
            extend(made.extensions, "KHR_materials_ior", {{"ior", tinygltf::Value(look.ior)}});
        if (!material.texture.empty()) {
            pbr.baseColorFactor = {1, 1, 1, look.opacity};
            pbr.baseColorTexture.index = texture_of(*surface.material);
            if (look.opacity == 1 && material.coverage < 1) made.alphaMode = "MASK"; // at 1/2, as graftal's
        }
        if (material.translucency > 0) let_light_through(made, material);
        model_.materials.push_back(std::move(made));
        return known->second;
    }

    /// A share of the diffuse light goes through, as in leaves, and takes on the colour of the surface.
    void let_light_through(tinygltf::Material& made, const Material& material) {
        GltfObject diffuse;
        diffuse["diffuseTransmissionFactor"] =
            tinygltf::Value(material.translucency / (material.translucency + material.diffuse));
        const auto& base = made.pbrMetallicRoughness;
        diffuse["diffuseTransmissionColorFactor"] = tinygltf::Value(tinygltf::Value::Array{
            tinygltf::Value(base.baseColorFactor[0]), tinygltf::Value(base.baseColorFactor[1]),
            tinygltf::Value(base.baseColorFactor[2])});
        if (base.baseColorTexture.index >= 0)
            diffuse["diffuseTransmissionColorTexture"] =
                tinygltf::Value(GltfObject{{"index", tinygltf::Value(base.baseColorTexture.index)}});
        extend(made.extensions, "KHR_materials_diffuse_transmission", std::move(diffuse));
    }

    int texture_of(MaterialId material) {
        const auto [known, is_new] = textures_.try_emplace(scene_.materials[material].texture,
                                                           static_cast<int>(model_.textures.size()));
        if (!is_new) return known->second;
        tinygltf::Image image;
        image.name = PictureCopies::stem(scene_.materials[material]);
        image.mimeType = "image/png";
        const std::vector<unsigned char> png = pictures_.png(material);
        image.bufferView = add_view(model_, std::as_bytes(std::span(png)), 0);
        tinygltf::Texture texture;
        texture.source = add_to(model_.images, std::move(image));
        model_.textures.push_back(std::move(texture));
        return known->second;
    }

    int add_top(tinygltf::Node node, const Affine& place_of) {
        place(node, *move_turn_scale(place_of));
        const int id = add_node(std::move(node));
        top_.push_back(id);
        return id;
    }

    void add_camera(double metres) {
        const View& view = job_.view;
        const Camera& eye = view.camera;
        const double aspect = static_cast<double>(view.size.width) / view.size.height;
        const Box& box = scene_.bounds;
        const double radius = box.empty() ? 1 : 0.5 * glm::length(box.size());
        const double away = box.empty() ? 1 : glm::length(box.centre() - eye.location);
        tinygltf::Camera camera;
        camera.name = "camera";
        const double far = 4 * (away + radius) * metres;
        if (eye.orthographic) {
            camera.type = "orthographic";
            camera.orthographic.xmag = 0.5 * eye.width * metres;
            camera.orthographic.ymag = camera.orthographic.xmag / aspect;
            camera.orthographic.znear = 0;
            camera.orthographic.zfar = far;
        } else {
            camera.type = "perspective";
            const double tangent = std::tan(0.5 * eye.angle_deg * std::numbers::pi / 180) / aspect;
            camera.perspective.yfov = 2 * std::atan(tangent);
            camera.perspective.aspectRatio = aspect;
            camera.perspective.znear = std::max(1e-3 * far, 0.05 * (away - radius) * metres);
            camera.perspective.zfar = far;
        }
        tinygltf::Node node;
        node.name = "camera";
        node.camera = add_to(model_.cameras, std::move(camera));
        add_top(std::move(node), {Mat3(eye.right, eye.up, -eye.direction), metres * eye.location});
    }

    void add_lights(double metres) {
        for (const Light& light : job_.view.lights) {
            const double most = std::max({light.rgb.r, light.rgb.g, light.rgb.b});
            if (!(most > 0)) continue;
            tinygltf::Light made;
            made.name = light.sun ? "sun" : "lamp";
            made.type = light.sun ? "directional" : "point";
            made.color = {light.rgb.r / most, light.rgb.g / most, light.rgb.b / most};
            const Vec3 middle = scene_.bounds.empty() ? Vec3(0.0) : scene_.bounds.centre();
            const double away = glm::length(light.location - middle) * metres;
            // POV-Ray's lamps do not fade: as bright where the model is.
            made.intensity = light_of_one * most * (light.sun ? 1 : away * away);
            const Vec3 back =
                glm::normalize(light.sun ? light.location : light.location - middle + Vec3(0, 1e-9, 0));
            const Vec3 aside = std::abs(back.y) < 0.9 ? Vec3(0, 1, 0) : Vec3(1, 0, 0);
            const Vec3 right = glm::normalize(glm::cross(aside, back));
            tinygltf::Node node;
            node.name = made.name;
            node.extensions["KHR_lights_punctual"] = tinygltf::Value(
                GltfObject{{"light", tinygltf::Value(add_to(model_.lights, std::move(made)))}});
            add_top(std::move(node), {Mat3(right, glm::cross(back, right), back),
                                      light.sun ? Vec3(0.0) : metres * light.location});
        }
    }

    const ExportJob& job_;
    const UnfoldedScene& scene_;
    std::vector<bool> held_; ///< until the meshes are grouped
    ShapeMeshes meshes_;
    PictureCopies pictures_;
    std::map<std::string, int> textures_; ///< by the model's name of the picture
    tinygltf::Model model_;
    MeshGroups groups_;
    std::vector<int> top_; ///< nodes of the scene
    std::map<SceneId, int> mesh_of_;
    std::map<std::pair<std::int64_t, bool>, int> material_of_;
};

template<bool binary> Status write_gltf(const ExportJob& job, ExportReport& report) {
    if (refuse_range(job, job.options.unit_mm.value_or(1000) / 1000)) return {};
    constexpr std::size_t most_looks = 1'000'000;
    std::optional<UnfoldedScene> scene = resolve_looks(job.scene, {most_looks}, job.model, job.diagnostics);
    job.too_large = !scene;
    if (!scene) return {};
    if (job.view.shows_sky_light)
        job.diagnostics.note(job.model, "glTF has no light of the sky: graftal leaves it out of the file");
    std::optional<std::vector<bool>> held = hold_parts(*scene, job.options.parts, job.model, job.diagnostics);
    if (!held) return {};
    GltfWriter writer(job, *scene, std::move(*held));
    Status made = writer.make();
    if (!made.ok() || job.diagnostics.has_errors()) return made;
    // The head of a binary file states its length in 32 bits.
    const std::uint64_t most_bytes =
        binary ? std::min<std::uint64_t>(job.options.most_bytes, UINT32_MAX) : job.options.most_bytes;
    OutputFile file(job.options.output, most_bytes, job.too_large);
    if (!file.ok()) return file.status();
    writer.write(file, binary);
    Status status = file.close();
    if (!status.ok()) return status;
    report.summary = writer.summary();
    return file.pending().commit();
}

constexpr ExportFormat gltf_row(std::string_view extension, std::string_view name, std::string_view summary,
                                decltype(ExportFormat::write) write) {
    return {.extension = extension,
            .name = name,
            .summary = summary,
            .meshes = SceneMeshes::by_size,
            .has_unit = true,
            .has_instancing = true,
            .has_nodes = true,
            .has_parts = true,
            .write = write};
}

} // namespace

const ExportFormat gltf_format =
    gltf_row(".gltf", "glTF 2.0", "shared meshes and nodes, for web pages and Blender; one text file",
             write_gltf<false>);
const ExportFormat glb_format =
    gltf_row(".glb", "glTF 2.0 (binary)", "the same, in one binary file", write_gltf<true>);

} // namespace graftal
