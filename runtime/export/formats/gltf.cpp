// glTF 2.0 and its binary form, by tinygltf. Meshes are shared, unions are not: each place is a node.

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <ostream>
#include <streambuf>

#include <tiny_gltf.h>

#include "compiler/unfolded/looks.h"
#include "runtime/export/formats/flat_files.h"
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
        tinygltf::Scene all;
        all.nodes = top_;
        model_.scenes.push_back(std::move(all));
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

    const MeshGroups& groups() const { return groups_; }

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
        model_.nodes.push_back(std::move(node));
        const int id = static_cast<int>(model_.nodes.size()) - 1;
        if (model_.nodes.size() == 1) top_.push_back(id);
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
            std::vector<float> moves, turns, scales;
            for (const MoveTurnScale& at : list) {
                for (int axis = 0; axis < 3; ++axis) {
                    moves.push_back(static_cast<float>(at.move[axis]));
                    scales.push_back(static_cast<float>(at.scale[axis]));
                }
                for (const double value : {at.turn.x, at.turn.y, at.turn.z, at.turn.w})
                    turns.push_back(static_cast<float>(value));
            }
            GltfObject attributes;
            attributes["TRANSLATION"] = tinygltf::Value(floats(moves, TINYGLTF_TYPE_VEC3, 0));
            attributes["ROTATION"] = tinygltf::Value(floats(turns, TINYGLTF_TYPE_VEC4, 0));
            attributes["SCALE"] = tinygltf::Value(floats(scales, TINYGLTF_TYPE_VEC3, 0));
            GltfObject extension;
            extension["attributes"] = tinygltf::Value(attributes);
            tinygltf::Node node;
            node.name = scene_.nodes[id].name;
            node.mesh = mesh_of(id);
            node.extensions["EXT_mesh_gpu_instancing"] = tinygltf::Value(extension);
            add_child(root, std::move(node));
            uses("EXT_mesh_gpu_instancing", true);
        }
    }

    void uses(const std::string& extension, bool required = false) {
        const auto add = [&](std::vector<std::string>& list) {
            if (std::ranges::find(list, extension) == list.end()) list.push_back(extension);
        };
        add(model_.extensionsUsed);
        if (required) add(model_.extensionsRequired);
    }

    int mesh_of(SceneId id) const {
        const auto known = mesh_of_.find(id);
        return known == mesh_of_.end() ? -1 : known->second;
    }

    template<typename Value> int view_of(const std::vector<Value>& values, int target) {
        std::vector<unsigned char>& data = model_.buffers[0].data;
        data.resize((data.size() + 3) / 4 * 4);
        tinygltf::BufferView view;
        view.buffer = 0;
        view.byteOffset = data.size();
        view.byteLength = values.size() * sizeof(Value);
        view.target = target;
        const auto* const bytes = reinterpret_cast<const unsigned char*>(values.data());
        data.insert(data.end(), bytes, bytes + view.byteLength);
        model_.bufferViews.push_back(std::move(view));
        return static_cast<int>(model_.bufferViews.size()) - 1;
    }

    int accessor(int view, std::size_t count, int component, int type) {
        tinygltf::Accessor accessor;
        accessor.bufferView = view;
        accessor.componentType = component;
        accessor.type = type;
        accessor.count = count;
        model_.accessors.push_back(std::move(accessor));
        return static_cast<int>(model_.accessors.size()) - 1;
    }

    int floats(const std::vector<float>& values, int type, int target) {
        return accessor(view_of(values, target),
                        values.size() / static_cast<std::size_t>(type == TINYGLTF_TYPE_VEC4   ? 4
                                                                 : type == TINYGLTF_TYPE_VEC3 ? 3
                                                                                              : 2),
                        TINYGLTF_COMPONENT_TYPE_FLOAT, type);
    }

    template<std::size_t n> int vectors(const std::vector<std::array<float, n>>& values, int type) {
        std::vector<float> all;
        for (const auto& value : values)
            all.insert(all.end(), value.begin(), value.end());
        return floats(all, type, TINYGLTF_TARGET_ARRAY_BUFFER);
    }

    void add_mesh(SceneId id) {
        tinygltf::Mesh mesh;
        mesh.name = scene_.nodes[id].name;
        for (const GroupSurface& surface : surfaces_of(scene_, id, meshes_))
            mesh.primitives.push_back(primitive_of(surface));
        if (mesh.primitives.empty()) return; // nothing of it is left in 32 bits
        mesh_of_[id] = static_cast<int>(model_.meshes.size());
        model_.meshes.push_back(std::move(mesh));
    }

    tinygltf::Primitive primitive_of(const GroupSurface& surface) {
        tinygltf::Primitive primitive;
        primitive.mode = TINYGLTF_MODE_TRIANGLES;
        const int positions = vectors(surface.vertices, TINYGLTF_TYPE_VEC3);
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
        primitive.attributes["NORMAL"] = vectors(surface.normals, TINYGLTF_TYPE_VEC3);
        if (!surface.uv.empty()) {
            std::vector<std::array<float, 2>> uv = surface.uv; // v downwards
            for (auto& point : uv)
                point[1] = 1 - point[1];
            primitive.attributes["TEXCOORD_0"] = vectors(uv, TINYGLTF_TYPE_VEC2);
        }
        if (surface.coloured) {
            std::vector<std::uint16_t> colours; // linear
            for (const Rgb& rgb : surface.colours) {
                for (int i = 0; i < 3; ++i)
                    colours.push_back(static_cast<std::uint16_t>(std::lround(65535 * rgb[i])));
                colours.push_back(65535);
            }
            const int colour =
                accessor(view_of(colours, TINYGLTF_TARGET_ARRAY_BUFFER), surface.colours.size(),
                         TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_VEC4);
            model_.accessors[static_cast<std::size_t>(colour)].normalized = true;
            primitive.attributes["COLOR_0"] = colour;
        }
        primitive.indices = indices_of(surface);
        primitive.material = material_of(surface);
        return primitive;
    }

    int indices_of(const GroupSurface& surface) {
        const std::size_t count = 3 * surface.triangles.size();
        if (surface.vertices.size() < 65535) {
            std::vector<std::uint16_t> small;
            for (const auto& t : surface.triangles)
                for (const std::uint32_t corner : t)
                    small.push_back(static_cast<std::uint16_t>(corner));
            return accessor(view_of(small, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER), count,
                            TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_SCALAR);
        }
        std::vector<std::uint32_t> large;
        for (const auto& t : surface.triangles)
            large.insert(large.end(), t.begin(), t.end());
        return accessor(view_of(large, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER), count,
                        TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR);
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
            if (most > 1) {
                GltfObject strength;
                strength["emissiveStrength"] = tinygltf::Value(most);
                made.extensions["KHR_materials_emissive_strength"] = tinygltf::Value(strength);
                uses("KHR_materials_emissive_strength");
            }
        }
        if (look.transmission > 0) {
            GltfObject transmission;
            transmission["transmissionFactor"] = tinygltf::Value(look.transmission);
            made.extensions["KHR_materials_transmission"] = tinygltf::Value(transmission);
            uses("KHR_materials_transmission");
        }
        if (look.transmission > 0 || material.has_coat()) {
            GltfObject ior;
            ior["ior"] = tinygltf::Value(look.ior);
            made.extensions["KHR_materials_ior"] = tinygltf::Value(ior);
            uses("KHR_materials_ior");
        }
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
        made.extensions["KHR_materials_diffuse_transmission"] = tinygltf::Value(diffuse);
        uses("KHR_materials_diffuse_transmission");
    }

    int texture_of(MaterialId material) {
        const auto [known, is_new] = textures_.try_emplace(scene_.materials[material].texture,
                                                           static_cast<int>(model_.textures.size()));
        if (!is_new) return known->second;
        tinygltf::Image image;
        image.name = PictureCopies::stem(scene_.materials[material]);
        image.mimeType = "image/png";
        image.bufferView = view_of(pictures_.png(material), 0);
        model_.images.push_back(std::move(image));
        tinygltf::Texture texture;
        texture.source = static_cast<int>(model_.images.size()) - 1;
        model_.textures.push_back(texture);
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
        model_.cameras.push_back(std::move(camera));
        tinygltf::Node node;
        node.name = "camera";
        node.camera = 0;
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
            GltfObject reference;
            reference["light"] = tinygltf::Value(static_cast<int>(model_.lights.size()));
            node.extensions["KHR_lights_punctual"] = tinygltf::Value(reference);
            model_.lights.push_back(std::move(made));
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
