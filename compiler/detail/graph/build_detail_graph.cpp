#include "compiler/detail/graph/build_detail_graph.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include <glm/common.hpp>

#include "compiler/detail/graph/edge_cell.h"
#include "compiler/graph/components.h"
#include "compiler/graph/path.h"
#include "compiler/support/stretch.h"

namespace graftal {

namespace {

/// Ending objects of at most this many primitives are drawn whole rather than replaced by a proxy.
constexpr double uncullable_leaves = 16;
/// A proxy is at least this share of its longest half axis thick, so that flat sets have a body.
constexpr double thinnest_proxy = 0.02;

Affine ellipsoid_in(const Box& box) {
    if (box.empty()) return {};
    Vec3 half = 0.5 * box.size();
    const double longest = std::max({half.x, half.y, half.z, 1e-12});
    half = glm::max(half, Vec3(thinnest_proxy * longest));
    return Affine::translate(box.centre()) * Affine::scale(half);
}

constexpr double flattest_map = 1e-9;

/// Builds the nodes of a graph, which it uses up: with millions of instances each must lie in memory once.
class Builder {
  public:
    Builder(Graph graph, const Components& components, const std::vector<ObjectBounds>& bounds,
            WorkMeter* meter)
        : graph_(std::move(graph)), components_(components), bounds_(bounds), meter_(meter) {}

    DetailGraph build() {
        const auto count = graph_.objects.size();
        cut_.nodes.resize(count);
        cut_.root = graph_.root;
        cut_.materials = graph_.materials;
        const std::vector<double> leaves = approximate_leaves();
        const std::vector<ObjectId> whole_of = wholes();
        for (ObjectId id = 0; id < count; ++id) {
            Object& object = graph_.objects[id];
            const ObjectBounds& bounds = bounds_[id];
            const bool part = whole_of[id] != id;
            DetailNode node;
            node.name = graph_.objects[whole_of[id]].name;
            node.primitive = object.primitive;
            node.combination = object.combination;
            node.unending = components_.unending[id];
            node.unbounded = bounds.unbounded;
            node.terminal_px = object.terminal_px;
            node.cullable =
                !part && (node.unending || leaves[id] > uncullable_leaves || node.terminal_px > 0);
            node.ball = bounds.ball.empty() ? Ball{Vec3(0.0), 0.0} : bounds.ball;
            node.node_from_proxy = ellipsoid_in(bounds.box);
            if (object.packed)
                add_cells(cut_, node, object.packed, *bounds.run,
                          [&](const Primitive& primitive) { return primitive_node(primitive); });
            const std::vector<Instance> instances = std::exchange(object.instances, {});
            node.edges.reserve(instances.size());
            for (const Instance& instance : instances) {
                if (meter_) meter_->add();
                if (!is_plane_on_a_line(instance)) node.edges.push_back(edge(instance, node, id));
            }
            if (object.terminal) {
                if (!is_plane_on_a_line(*object.terminal))
                    node.stop_edges.push_back(edge(*object.terminal, node, id));
                node.terminal = true;
            } else if (node.unending && !part &&
                       (node.combination != Combination::subtract || ends(node.edges.front()))) {
                for (const DetailEdge& candidate : node.edges)
                    if (ends(candidate)) node.stop_edges.push_back(candidate);
            }
            cut_.nodes[id] = std::move(node);
        }
        return std::move(cut_);
    }

  private:
    /// The whole of each object: for a part the object that it is a part of, else itself.
    std::vector<ObjectId> wholes() const {
        std::vector<ObjectId> whole_of(graph_.objects.size());
        std::iota(whole_of.begin(), whole_of.end(), 0u);
        for (ObjectId id = 0; id < graph_.objects.size(); ++id)
            for (const Instance& instance : graph_.objects[id].instances)
                if (is_part(instance, components_)) whole_of[instance.master] = id;
        return whole_of;
    }

    /// Whether it leads to an ending object, maybe by a detour.
    bool ends(const DetailEdge& edge) const {
        return edge.levels == 0 && (edge.child >= graph_.objects.size() || !components_.unending[edge.child]);
    }

    NodeId primitive_node(const Primitive& primitive) {
        for (ObjectId id = 0; id < graph_.objects.size(); ++id)
            if (graph_.objects[id].primitive == primitive) return id;
        for (auto id = static_cast<NodeId>(graph_.objects.size()); id < cut_.nodes.size(); ++id)
            if (cut_.nodes[id].primitive == primitive) return id;
        const ObjectBounds bounds = primitive_bounds(primitive);
        DetailNode node;
        node.name = name_of(primitive);
        node.primitive = primitive;
        node.unbounded = bounds.unbounded;
        node.cullable = false;
        node.ball = bounds.ball;
        node.node_from_proxy = ellipsoid_in(bounds.box);
        cut_.nodes.push_back(std::move(node));
        return static_cast<NodeId>(cut_.nodes.size() - 1);
    }

    /// A plane that a map crushes so shows nothing.
    bool is_plane_on_a_line(const Instance& instance) const {
        return is_flat_plane(instance) && !place_of_plane(instance.parent_from_child);
    }

    bool is_flat_plane(const Instance& instance) const {
        return graph_.objects[instance.master].primitive == PrimitiveKind::plane &&
               is_singular(instance.parent_from_child, flattest_plane);
    }

    DetailEdge edge(const Instance& instance, const DetailNode& node, ObjectId user) {
        DetailEdge edge{instance.master, instance.parent_from_child, PathTint(instance.tint),
                        instance.material, levels_of(instance, components_)};
        if (is_flat_plane(instance))
            edge.node_from_child = place_of_plane(edge.node_from_child).value_or(Affine());
        const Vec3 sigma = singular_values(edge.node_from_child.linear);
        edge.stretch = sigma.x;
        edge.volume_stretch = std::cbrt(sigma.x * sigma.y * sigma.z);
        if (!(edge.volume_stretch > 0)) edge.volume_stretch = edge.stretch; // of endless times 0 too
        edge.similarity = sigma.z > sigma.x * (1 - 1e-9);
        cut_.tinted = cut_.tinted || instance.tint.alpha > 0;
        const bool in_cycle = components_.component_of[user] == components_.component_of[instance.master];
        if (in_cycle && sigma.x >= 0.97) cut_.contractive = false;
        // A plane has no mesh that could be crushed.
        const bool crushed =
            !bounds_[instance.master].unbounded && is_singular(edge.node_from_child, flattest_map);
        return crushed ? sealed_detour(edge, node) : edge;
    }

    /// A node between the two that holds the singular edge alone; the edge to it is the identity. It takes
    /// over the level, and passes on what it is asked to draw, cut or not.
    DetailEdge sealed_detour(DetailEdge edge, const DetailNode& node) {
        DetailNode detour;
        detour.name = node.name;
        detour.unending = edge.levels > 0;
        detour.sealed = true;
        detour.cullable = false;
        detour.ball = node.ball;
        detour.node_from_proxy = node.node_from_proxy;
        const unsigned levels = edge.levels;
        edge.levels = 0;
        detour.edges = {edge};
        detour.stop_edges = {edge};
        cut_.nodes.push_back(std::move(detour));
        return {static_cast<NodeId>(cut_.nodes.size() - 1), {}, {}, {}, levels, 1, 1, true};
    }

    std::vector<double> approximate_leaves() const {
        std::vector<double> leaves(graph_.objects.size(), 0);
        for (const auto& members : components_.members)
            for (const ObjectId id : members) {
                const Object& object = graph_.objects[id];
                leaves[id] = object.primitive ? 1 : static_cast<double>(object.packed.size());
                for (const Instance& instance : graph_.objects[id].instances)
                    leaves[id] += leaves[instance.master];
            }
        return leaves;
    }

    Graph graph_;
    const Components& components_;
    const std::vector<ObjectBounds>& bounds_;
    WorkMeter* meter_;
    DetailGraph cut_;
};

/// Until it is known how much is seen of them, edges weigh as much as the squares that they reach over.
void weigh_by_reach(DetailGraph& cut) {
    for (DetailNode& node : cut.nodes)
        for (DetailEdge& edge : node.edges) {
            const double reach = edge.stretch * std::max(cut.nodes[edge.child].ball.radius, 1e-9);
            edge.weight = std::max(reach * reach, 1e-300);
        }
}

void mark_textured(DetailGraph& cut) {
    const std::vector<NodeId> order = masters_first(cut);
    const auto is_painted = [&](const std::optional<MaterialId>& material) {
        return material && cut.materials[*material].is_painted();
    };
    const auto shows_paint = [&](const DetailEdge& edge) {
        return cut.nodes[edge.child].textured || is_painted(edge.material);
    };
    for (bool changed = true; changed;) {
        changed = false;
        for (const NodeId id : order) {
            DetailNode& node = cut.nodes[id];
            if (node.textured) continue;
            node.textured = (node.cell && std::ranges::any_of(node.cell->source->materials, is_painted)) ||
                            std::ranges::any_of(node.edges, shows_paint) ||
                            std::ranges::any_of(node.stop_edges, shows_paint);
            changed = changed || node.textured;
        }
    }
}

/// Gives wholes the edges of their parts for as long as it lives: a part looks as its whole does.
class JoinedParts {
  public:
    explicit JoinedParts(DetailGraph& cut) : cut_(cut) {
        for (NodeId id = 0; id < cut.nodes.size(); ++id) {
            DetailNode& node = cut.nodes[id];
            // A detour has taken over the level of its edge: what it leads to is no part.
            if (node.sealed ||
                std::ranges::none_of(node.edges, [&](const DetailEdge& edge) { return leads_to_part(edge); }))
                continue;
            std::vector<DetailEdge> joined;
            for (const DetailEdge& edge : node.edges) {
                if (leads_to_part(edge)) {
                    std::vector<DetailEdge>& held = cut.nodes[edge.child].edges;
                    parts_.push_back({id, edge.child, joined.size(), held.size()});
                    joined.insert(joined.end(), held.begin(), held.end());
                    held.clear();
                } else {
                    joined.push_back(edge);
                }
            }
            wholes_.emplace_back(id, std::exchange(node.edges, std::move(joined)));
        }
    }

    ~JoinedParts() {
        for (const Part& part : parts_) {
            const DetailNode& whole = cut_.nodes[part.whole];
            DetailNode& node = cut_.nodes[part.part];
            const auto first = whole.edges.begin() + static_cast<std::ptrdiff_t>(part.first);
            node.edges.assign(first, first + static_cast<std::ptrdiff_t>(part.count));
            node.mean = whole.mean;
            node.textured = whole.textured;
        }
        for (auto& [id, edges] : wholes_)
            cut_.nodes[id].edges = std::move(edges);
    }

    JoinedParts(const JoinedParts&) = delete;
    JoinedParts& operator=(const JoinedParts&) = delete;

  private:
    struct Part {
        NodeId whole, part;
        std::size_t first, count; ///< of its edges among those of the whole
    };

    bool leads_to_part(const DetailEdge& edge) const {
        return edge.levels == 0 && cut_.nodes[edge.child].unending;
    }

    DetailGraph& cut_;
    std::vector<Part> parts_;
    std::vector<std::pair<NodeId, std::vector<DetailEdge>>> wholes_;
};

} // namespace

DetailGraph build_detail_graph(Graph graph, const std::vector<ObjectBounds>& bounds, WorkMeter* meter) {
    const Components components = strong_components(graph);
    DetailGraph cut = Builder(std::move(graph), components, bounds, meter).build();
    {
        const JoinedParts joined(cut);
        mark_textured(cut);
        weigh_by_reach(cut);
        set_mean_colours(cut);
    }
    return cut;
}

} // namespace graftal
