#include "runtime/gpu/flat_model.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "compiler/primitives/solid.h"
#include "compiler/primitives/tapered.h"
#include "compiler/primitives/tessellate.h"
#include "compiler/primitives/texture_space.h"
#include "compiler/support/stage_price.h"
#include "runtime/gpu/flat_boxes.h"
#include "runtime/gpu/flat_cells.h"
#include "runtime/gpu/flat_light.h"
#include "runtime/gpu/flat_words.h"
#include "runtime/gpu/near_layers.h"

namespace graftal {

namespace {

/// Entries are words of 32 bits that hold their kind, too.
constexpr std::size_t most_edges = ENTRY_NUMBER;
/// Memory that an instance takes while the arrays are made.
constexpr std::uint64_t bytes_an_edge = 512;

glm::vec4 of_paint(const Paint& paint) {
    return {paint.fixed[0], paint.fixed[1], paint.fixed[2], paint.open};
}

/// Material 0 is that of what names none.
std::uint32_t material_number(std::uint32_t material) {
    return material == flat_none ? NONE : material + 1;
}

/// Whether what an edge places is flat, or is so once a cycle comes to it again.
bool may_crush(const FlatGraph& graph, const FlatEdge& edge) {
    const FlatNode& child = graph.nodes[edge.child];
    if (edge.crushes || child.primitive != flat_none) return edge.crushes;
    constexpr double flat = 1e-4, flat_twice = 1e-3;
    return is_singular(Affine{linear_of(edge), {}}, child.unending ? flat_twice : flat);
}

/// Whether rays keep their direction in the child's frame.
bool keeps_directions(const FlatEdge& edge) {
    if (edge.crushes) return false;
    for (std::size_t i = 0; i < 9; ++i)
        if (!(std::abs(edge.linear[i].high * edge.stretch - (i % 4 == 0 ? 1.0f : 0.0f)) < 1e-6f))
            return false;
    return true;
}

class Flattener {
  public:
    Flattener(const FlatGraph& graph, FlatModel& flat)
        : graph_(graph), cells_(flat_cells(graph)), flat_(flat) {}

    /// False where that would take too much memory.
    bool run(Vec3 eye, const Box& drawn, std::uint32_t root_steps, std::uint64_t most_bytes) {
        for (const Primitive& primitive : graph_.primitives) {
            meshes_.push_back(mesh_of(primitive));
            if (flat_.bytes() > most_bytes) return false;
        }
        add_root(eye);
        for (const PassedEdge& edge : cells_.edges)
            add_edge(edge);
        for (std::size_t id = 0; id < graph_.nodes.size(); ++id)
            add_node(graph_.nodes[id], cells_.shallow[id]);
        for (std::size_t id = 0; id < graph_.nodes.size(); ++id)
            add_cells(id);
        for (std::size_t part = 0; part < flat_.parts.size(); part += PART_SIZE) {
            const std::size_t node = std::bit_cast<std::uint32_t>(flat_.parts[part + 3].y) * NODE_SIZE;
            flat_.parts[part + 4] = flat_.nodes[node + NODE_BALL];
            flat_.parts[part + 5] = flat_.nodes[node + NODE_FACTS];
        }
        std::vector<FlatItem> root = {{{drawn.min - eye, drawn.max - eye}, ENTRY_PART}};
        flat_.scene.counts.y = build_flat_boxes(root, flat_.boxes);
        flat_.scene.counts.z = root_steps;
        return true;
    }

  private:
    /// The part that leads from the world to the root; those of the edges follow.
    void add_root(Vec3 eye) {
        const Affine& place = graph_.world_from_root;
        FlatEdge edge;
        edge.child = graph_.root;
        edge.stretch = static_cast<float>(place.linear[0][0]);
        const Mat3 inverse_linear = inverse(place).linear;
        for (std::size_t i = 0; i < 9; ++i)
            edge.linear[i] = FloatPair(inverse_linear[static_cast<int>(i / 3)][static_cast<int>(i % 3)]);
        for (std::size_t i = 0; i < 3; ++i)
            edge.origin[i] = FloatPair(place.translation[static_cast<int>(i)] - eye[static_cast<int>(i)]);
        add_edge({edge});
    }

    void add_edge(const PassedEdge& passed) {
        const FlatEdge& edge = passed.edge;
        const auto& m = edge.linear;
        for (std::size_t row = 0; row < 3; ++row) {
            flat_.parts.emplace_back(m[row].high, m[3 + row].high, m[6 + row].high, edge.origin[row].high);
            if (flat_.features.paired)
                flat_.lows.emplace_back(m[row].low, m[3 + row].low, m[6 + row].low, edge.origin[row].low);
        }
        flat_.parts.emplace_back(edge.stretch, flat_bits(edge.child),
                                 flat_bits(material_number(edge.material)),
                                 flat_bits(edge.levels | (edge.crushes ? PART_OUTWARDS : 0)));
        flat_.parts.resize(flat_.parts.size() + 2);
        const std::uint32_t primitive = graph_.nodes[edge.child].primitive;
        FlatModel::Features& features = flat_.features;
        features.stretched =
            features.stretched || features.crushed || (primitive == flat_none && !is_similarity(edge));
        const bool is_mesh = primitive != flat_none && meshes_[primitive] != NONE;
        if (primitive == flat_none || is_mesh) features.even = features.even && keeps_directions(edge);
        if (primitive != flat_none)
            features.kinds |=
                1u << (is_mesh ? KIND_MESH : static_cast<unsigned>(graph_.primitives[primitive].kind()));
        flat_.looks.push_back(of_paint(edge.tint));
        flat_.looks.emplace_back(edge.turns, flat_bits(part_number(passed.before)),
                                 flat_bits(part_number(passed.last)), 0);
    }

    static std::uint32_t part_number(std::uint32_t edge) { return edge == flat_none ? NONE : edge + 1; }

    void add_node(const FlatNode& node, std::span<const std::uint32_t> shallow) {
        std::uint32_t flags = 0, tree = NONE, stop_tree = NONE;
        float repeats_u = 0, shape = 0, inner_radius = 1;
        if (node.primitive != flat_none) {
            const Primitive& primitive = graph_.primitives[node.primitive];
            tree = meshes_[node.primitive];
            flags =
                NODE_PRIMITIVE | (tree == NONE ? static_cast<std::uint32_t>(primitive.kind()) : KIND_MESH);
            if (primitive == PrimitiveKind::cylinder || primitive == PrimitiveKind::cone ||
                primitive == PrimitiveKind::frustum)
                shape = static_cast<float>(top_radius(primitive));
            if (tree != NONE) {
                const TextureWrap& wrap = traits_of(primitive).wrap;
                repeats_u = wrap.around ? 1 : 0;
                shape = wrap.evenly ? 1 : 0;
            }
            if (encloses_volume(primitive)) flags |= NODE_SOLID;
            inner_radius = static_cast<float>(traits_of(primitive).inner_radius(primitive));
        } else {
            if (node.unending) flags |= NODE_UNENDING;
            if (node.terminal) flags |= NODE_TERMINAL;
            if (node.faint) flags |= NODE_FAINT;
            if (node.widens) flags |= NODE_WIDENS;
            tree = tree_of(shallow);
            std::vector<std::uint32_t> stops(node.stop_edge_count);
            std::iota(stops.begin(), stops.end(), node.first_edge + node.edge_count);
            stop_tree = tree_of(stops);
        }
        flat_.nodes.emplace_back(node.centre[0], node.centre[1], node.centre[2], 0.5f * node.diameter);
        flat_.nodes.emplace_back(node.cut_detail, flat_bits(flags), flat_bits(tree), flat_bits(stop_tree));
        const Affine proxy = frame_from_proxy(node);
        const Affine proxy_from_frame = is_singular(proxy) ? Affine() : inverse(proxy);
        for (int row = 0; row < 3; ++row)
            flat_.nodes.push_back(flat_four({proxy_from_frame.linear[0][row], proxy_from_frame.linear[1][row],
                                             proxy_from_frame.linear[2][row]},
                                            proxy_from_frame.translation[row]));
        flat_.nodes.push_back(of_paint(node.mean));
        flat_.nodes.push_back(node.primitive == flat_none ? of_paint(node.proxy)
                                                          : extents(graph_.primitives[node.primitive]));
        flat_.nodes.emplace_back(flat_bits(material_number(node.finish)),
                                 node.primitive == flat_none ? node.reach : repeats_u, shape, inner_radius);
        flat_.nodes.emplace_back(0);
    }

    /// The deepest first, after all nodes.
    void add_cells(std::size_t id) {
        const std::vector<FlatCell>& deep = cells_.deep[id];
        glm::vec4& facts = flat_.nodes[id * NODE_SIZE + NODE_CELLS];
        facts.x = flat_bits(static_cast<std::uint32_t>(flat_.nodes.size()));
        facts.y = flat_bits(static_cast<std::uint32_t>(deep.size()));
        for (auto cell = deep.rbegin(); cell != deep.rend(); ++cell)
            flat_.nodes.emplace_back(cell->least_size, cell->reach, flat_bits(tree_of(cell->edges)),
                                     flat_bits(cell->least_steps));
    }

    /// Half of a primitive's extents, and 1 if it has bounds.
    static glm::vec4 extents(const Primitive& primitive) {
        const PrimitiveTraits& traits = traits_of(primitive);
        return traits.bounded ? flat_four(0.5 * traits.box(primitive).size(), 1) : glm::vec4(0);
    }

    std::uint32_t tree_of(std::span<const std::uint32_t> edges) {
        std::vector<FlatItem> items;
        for (const std::uint32_t i : edges)
            items.push_back({box_of(cells_.edges[i].edge), ENTRY_PART | (i + 1)});
        return build_flat_boxes(items, flat_.boxes);
    }

    /// The tree of triangles of a primitive that the kernel does not meet as it is; else NONE.
    std::uint32_t mesh_of(const Primitive& primitive) {
        static_assert(static_cast<int>(PrimitiveKind::frustum) == KIND_FRUSTUM &&
                      static_cast<int>(PrimitiveKind::torus) == KIND_TORUS &&
                      static_cast<int>(PrimitiveKind::cone) == KIND_CONE);
        if (form_of(primitive.kind()) != PrimitiveForm::shaped) return NONE;
        const TessellatedPrimitive& mesh = tessellated(primitive, max_fineness(primitive));
        std::vector<FlatItem> items;
        for (const auto& corners : mesh.triangles) {
            const std::array<Vec3, 3> at = {mesh.vertices[corners[0]], mesh.vertices[corners[1]],
                                            mesh.vertices[corners[2]]};
            const Vec3 level = glm::normalize(glm::cross(at[1] - at[0], at[2] - at[0]));
            const std::array<TexturePoint, 3> uv = flat_.features.pictured
                                                       ? texture_coordinates(primitive, {}, at)
                                                       : std::array<TexturePoint, 3>{};
            Box box;
            for (std::size_t k = 0; k < 3; ++k) {
                box.include(at[k]);
                flat_.triangles.push_back(flat_four(at[k], uv[k][0]));
            }
            for (std::size_t k = 0; k < 3; ++k)
                flat_.triangles.push_back(
                    flat_four(mesh.normals.empty() ? level : mesh.normals[corners[k]], uv[k][1]));
            items.push_back({box, ENTRY_TRIANGLE | static_cast<std::uint32_t>(
                                                       flat_.triangles.size() / TRIANGLE_SIZE - 1)});
        }
        return build_flat_boxes(items, flat_.boxes);
    }

    const FlatGraph& graph_;
    const FlatCells cells_;
    FlatModel& flat_;
    std::vector<std::uint32_t> meshes_; ///< by primitive
};

/// Parts of the model that no array of the kernel holds.
std::string lack(const FlatRequest& request) {
    if (request.textures.of_ground) return "a picture on the ground";
    if (std::ranges::any_of(request.prepared.cut.nodes, &DetailNode::is_combined))
        return "an intersection or a difference";
    if (request.detail.error_px > SelfShadows::lit_as_px)
        return "parts culled that are larger than half a pixel";
    if (request.limits.list || request.view.lights.size() > MOST_LAMPS) return "a long list of lights";
    return "";
}

/// Whether the view shows parts of the root that are too small for places of single precision. Rounding moves
/// rays by about 1e-7 of the root's size, and that is to stay far below a pixel.
bool needs_pairs(const View& view, const Box& drawn) {
    const Camera& camera = view.camera;
    if (drawn.empty()) return false;
    const double size = glm::length(drawn.size());
    const double distance =
        glm::length(glm::max(glm::max(drawn.min - camera.location, camera.location - drawn.max), 0.0));
    const double pixel =
        (camera.orthographic ? camera.width
                             : 2 * std::tan(camera.angle_deg * std::numbers::pi / 360) * distance) /
        view.size.width;
    constexpr double most_pixels = 1e5;
    return !(size < most_pixels * pixel);
}

} // namespace

std::uint64_t FlatModel::bytes() const {
    std::uint64_t count = 0;
    for (const auto* array : {&boxes, &parts, &lows, &nodes, &looks, &materials, &triangles})
        count += array->size() * sizeof(glm::vec4);
    return count + texels.size() * sizeof(float) + sizeof(scene);
}

std::optional<FlatModel> flat_model(const FlatRequest& request, std::string& why) {
    why = lack(request);
    if (!why.empty()) return std::nullopt;
    const TraceBasis basis(request.prepared, request.detail.work_seconds);
    const Camera& camera = request.view.camera;
    const Vec3 to_model = basis.bounds.node[basis.layers.cut.root].centre() - camera.location;
    if (has_near_layers(basis.bounds, camera.orthographic ? glm::dot(to_model, camera.direction) : 0)) {
        why = "layers nearer to each other than single precision tells";
        return std::nullopt;
    }
    std::uint64_t edges = 0;
    for (const DetailNode& node : basis.layers.cut.nodes)
        edges += edge_count(node, false) + node.stop_edges.size();
    const std::uint64_t most_bytes = request.detail.memory_bytes;
    if (edges > std::min<std::uint64_t>(most_edges, most_bytes / bytes_an_edge)) {
        why = fmt::format("{} instances within {} MiB", edges, most_bytes >> 20);
        return std::nullopt;
    }
    const std::optional<FlatGraph> graph =
        flat_graph(basis.layers, basis.bounds, request.detail.error_px, most_edges);
    if (!graph) {
        why = "a plane below a singular map";
        return std::nullopt;
    }
    FlatModel flat;
    flat.features.pictured = std::ranges::any_of(request.textures.of_material,
                                                 [](const auto& texture) { return texture != nullptr; });
    flat.features.crushed =
        std::ranges::any_of(graph->edges, [&](const FlatEdge& edge) { return may_crush(*graph, edge); });
    flat.features.paired = needs_pairs(request.view, basis.bounds.node[graph->root]);
    constexpr double far = flat_endless;
    const bool fits = Flattener(*graph, flat)
                          .run(request.view.camera.location,
                               basis.layers.cut.nodes[graph->root].unbounded ? Box{Vec3(-far), Vec3(far)}
                                                                             : basis.bounds.node[graph->root],
                               request.prepared.root_steps, most_bytes);
    if (!fits) {
        why = fmt::format("such fine meshes within {} MiB", most_bytes >> 20);
        return std::nullopt;
    }
    flat.source = basis.layers.source;
    add_light(request, basis, flat);
    return flat;
}

} // namespace graftal
