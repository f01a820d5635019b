#include "compiler/detail/cut_graph.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "compiler/detail/run_cells.h"
#include "compiler/passes/drop_unreachable.h"
#include "compiler/passes/merge_equivalent.h"
#include "compiler/support/check.h"
#include "compiler/support/stretch.h"

namespace graftal {

namespace {

/// Ending objects of at most this many primitives are drawn whole rather than replaced by a proxy.
constexpr double uncullable_leaves = 16;
/// A proxy is at least this share of its longest half axis thick, so that flat sets have a body.
constexpr double thinnest_proxy = 0.02;

/// What moves from an object to the edges that lead to it, and where those edges then lead.
struct Factor {
    Instance instance; ///< master, map, tint and material to compose with
    Box box;           ///< of the object once the map is taken out
    Ball ball;
    bool unbounded = false;
    std::shared_ptr<const RunBounds> run; ///< of an object that has one
};

/// Names point into the graph that was there first.
using FactorsByName = std::unordered_map<std::string_view, const Factor*>;

Tint composed(const Tint& parent, const Tint& child) {
    const PathTint path = PathTint(parent) * PathTint(child);
    return path.alpha > 0 ? Tint{path.premultiplied / path.alpha, path.alpha} : Tint{};
}

Instance composed(const Instance& parent, const Instance& child) {
    return {child.master, parent.parent_from_child * child.parent_from_child,
            composed(parent.tint, child.tint), child.material ? child.material : parent.material,
            parent.span};
}

bool share_placement(const Instance& a, const Instance& b) {
    return a.parent_from_child == b.parent_from_child && a.tint == b.tint && a.material == b.material;
}

bool factorable(const Object& object) {
    if (object.primitive || object.run) return false;
    const Instance& first = object.instances.front();
    if (is_singular(first.parent_from_child)) return false;
    for (const Instance& instance : object.instances)
        if (!share_placement(instance, first)) return false;
    return !object.terminal ||
           (object.terminal->tint == first.tint && object.terminal->material == first.material);
}

Ball enclosing_ball(const Box& box, const std::vector<Ball>& balls) {
    if (box.empty()) return {};
    Ball best{box.centre(), 0.5 * glm::length(box.size())};
    double reach = 0;
    for (const Ball& ball : balls)
        if (!ball.empty()) reach = std::max(reach, glm::distance(best.centre, ball.centre) + ball.radius);
    best.radius = std::min(best.radius, reach);
    return best;
}

/// Splits every object into a factor and what is left, in place.
std::vector<Factor> take_out_factors(Graph& graph, const Components& components,
                                     const std::vector<ObjectBounds>& bounds) {
    std::vector<Factor> factors(graph.objects.size());
    // Masters first, so that chains of single instances collapse in one sweep.
    for (const auto& members : components.members) {
        for (const ObjectId id : members) {
            Object& object = graph.objects[id];
            Factor& factor = factors[id];
            factor = {{id, {}, {}, {}, object.span},
                      bounds[id].box,
                      bounds[id].ball,
                      bounds[id].unbounded,
                      bounds[id].run};
            if (id == graph.root || !factorable(object)) continue;
            const Instance first = object.instances.front();
            if (object.instances.size() == 1 && !components.unending[id] && !object.terminal) {
                const Factor& master = factors[first.master];
                factor = {composed(first, master.instance), master.box, master.ball, factor.unbounded,
                          nullptr};
                continue;
            }
            factor.instance.parent_from_child = first.parent_from_child;
            factor.instance.tint = first.tint;
            factor.instance.material = first.material;
            Box box;
            std::vector<Ball> balls;
            for (Instance& instance : object.instances) {
                box.include(bounds[instance.master].box);
                balls.push_back(bounds[instance.master].ball);
                instance.parent_from_child = {};
                instance.tint = {};
                instance.material = {};
            }
            factor.box = box;
            factor.ball = enclosing_ball(box, balls);
            if (object.terminal) {
                object.terminal->parent_from_child =
                    inverse(first.parent_from_child) * object.terminal->parent_from_child;
                object.terminal->tint = {};
                object.terminal->material = {};
            }
        }
    }
    return factors;
}

void apply_factors(Graph& graph, const std::vector<Factor>& factors) {
    for (Object& object : graph.objects) {
        for (Instance& instance : object.instances)
            instance = composed(instance, factors[instance.master].instance);
        if (object.terminal)
            *object.terminal = composed(*object.terminal, factors[object.terminal->master].instance);
    }
}

Affine ellipsoid_in(const Box& box) {
    if (box.empty()) return {};
    Vec3 half = 0.5 * box.size();
    const double longest = std::max({half.x, half.y, half.z, 1e-12});
    half = glm::max(half, Vec3(thinnest_proxy * longest));
    return Affine::translate(box.centre()) * Affine::scale(half);
}

constexpr double flattest_map = 1e-9;

/// Builds the nodes of a factored graph, which it uses up: with millions of instances each must lie in memory
/// once.
class Builder {
  public:
    Builder(Graph graph, const Components& components) : graph_(std::move(graph)), components_(components) {}

    CutGraph build(const FactorsByName& factor_of) {
        const auto count = graph_.objects.size();
        cut_.nodes.resize(count);
        cut_.root = graph_.root;
        cut_.materials = graph_.materials;
        const std::vector<double> leaves = approximate_leaves();
        for (const Object& object : graph_.objects)
            holds_plane_.push_back(factor_of.at(object.name)->unbounded);
        for (ObjectId id = 0; id < count; ++id) {
            Object& object = graph_.objects[id];
            const Factor& factor = *factor_of.at(object.name);
            CutNode node;
            node.name = object.name;
            node.primitive = object.primitive;
            node.unending = components_.unending[id];
            node.unbounded = factor.unbounded;
            node.terminal_px = object.terminal_px;
            node.cullable = node.unending || leaves[id] > uncullable_leaves || node.terminal_px > 0;
            node.ball = factor.ball.empty() ? Ball{Vec3(0.0), 0.0} : factor.ball;
            node.node_from_proxy = ellipsoid_in(factor.box);
            if (object.run) add_run(object, *factor.run, node);
            const std::vector<Instance> instances = std::exchange(object.instances, {});
            node.edges.reserve(instances.size());
            for (std::size_t i = 0; i < instances.size(); ++i) {
                if (is_plane_on_a_line(instances[i])) continue;
                node.edges.push_back(edge(instances[i], node, id));
                if (id == graph_.root) cut_.root_instances.push_back(i);
            }
            if (object.terminal) {
                if (!is_plane_on_a_line(*object.terminal))
                    node.stop_edges.push_back(edge(*object.terminal, node, id));
                node.terminal = true;
            } else if (node.unending) {
                for (const CutEdge& candidate : node.edges)
                    if (candidate.levels == 0) node.stop_edges.push_back(candidate);
            }
            cut_.nodes[id] = std::move(node);
        }
        return std::move(cut_);
    }

  private:
    void add_run(const Object& object, const RunBounds& bounds, CutNode& node) {
        auto source = std::make_shared<RunSource>();
        source->run = object.run;
        source->materials = object.run_materials;
        std::array<bool, primitive_kind_count> met{};
        for (std::size_t i = 0; i < object.run->size(); ++i) {
            const RunItem& item = (*object.run)[i];
            for (const PrimitiveKind kind : {item.kind, item.ball ? PrimitiveKind::sphere : item.kind}) {
                if (std::exchange(met[static_cast<std::size_t>(kind)], true)) continue;
                source->child[static_cast<std::size_t>(kind)] = primitive_node(kind);
            }
        }
        add_run_nodes(cut_, node, source, bounds);
    }

    NodeId primitive_node(PrimitiveKind kind) {
        for (ObjectId id = 0; id < graph_.objects.size(); ++id)
            if (graph_.objects[id].primitive == kind) return id;
        for (auto id = static_cast<NodeId>(graph_.objects.size()); id < cut_.nodes.size(); ++id)
            if (cut_.nodes[id].primitive == kind) return id;
        const ObjectBounds bounds = primitive_bounds(kind);
        CutNode node;
        node.name = name_of(kind);
        node.primitive = kind;
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

    CutEdge edge(const Instance& instance, const CutNode& node, ObjectId user) {
        CutEdge edge{instance.master, instance.parent_from_child, PathTint(instance.tint), instance.material,
                     components_.unending[instance.master] ? 1u : 0u};
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
            !holds_plane_[instance.master] && is_singular(edge.node_from_child, flattest_map);
        return crushed ? sealed_detour(std::move(edge), node) : edge;
    }

    /// A node between the two that holds the singular edge alone; the edge to it is the identity. It takes
    /// over the level, and passes on what it is asked to draw, cut or not.
    CutEdge sealed_detour(CutEdge edge, const CutNode& node) {
        CutNode detour;
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
                leaves[id] = object.primitive ? 1
                             : object.run     ? static_cast<double>(object.run->part_count())
                                              : 0;
                for (const Instance& instance : graph_.objects[id].instances)
                    leaves[id] += leaves[instance.master];
            }
        return leaves;
    }

    Graph graph_;
    const Components& components_;
    std::vector<bool> holds_plane_; ///< by object
    CutGraph cut_;
};

/// Until it is known how much is seen of them, edges weigh as much as the squares that they reach over.
void weigh_by_reach(CutGraph& cut) {
    for (CutNode& node : cut.nodes)
        for (CutEdge& edge : node.edges) {
            const double reach = edge.stretch * std::max(cut.nodes[edge.child].ball.radius, 1e-9);
            edge.weight = std::max(reach * reach, 1e-300);
        }
}

void mark_textured(CutGraph& cut) {
    const std::vector<NodeId> order = masters_first(cut);
    const auto has_picture = [&](const std::optional<MaterialId>& material) {
        return material && !cut.materials[*material].texture.empty();
    };
    const auto shows_picture = [&](const CutEdge& edge) {
        return cut.nodes[edge.child].textured || has_picture(edge.material);
    };
    for (bool changed = true; changed;) {
        changed = false;
        for (const NodeId id : order) {
            CutNode& node = cut.nodes[id];
            if (node.textured) continue;
            node.textured = (node.cell && std::ranges::any_of(node.cell->source->materials, has_picture)) ||
                            std::ranges::any_of(node.edges, shows_picture) ||
                            std::ranges::any_of(node.stop_edges, shows_picture);
            changed = changed || node.textured;
        }
    }
}

MeanColour mean_of(const CutGraph& cut, const CutNode& node) {
    MeanColour sum{Rgb(0.0), 0};
    double weights = 0;
    for (const CutEdge& edge : node.edges) {
        MeanColour mean = cut.nodes[edge.child].mean;
        if (edge.material) mean = {mean.over(cut.materials[*edge.material].rgb), 0};
        sum.fixed += edge.weight * edge.tint.over(mean.fixed);
        sum.open += edge.weight * (1 - edge.tint.alpha) * mean.open;
        weights += edge.weight;
    }
    return {sum.fixed / weights, sum.open / weights};
}

} // namespace

std::vector<NodeId> masters_first(const CutGraph& cut) {
    std::vector<NodeId> order;
    std::vector<bool> met(cut.nodes.size(), false);
    std::vector<std::pair<NodeId, std::size_t>> path;
    for (NodeId start = 0; start < cut.nodes.size(); ++start) {
        if (!met[start]) path.emplace_back(start, 0);
        met[start] = true;
        while (!path.empty()) {
            const std::vector<CutEdge>& edges = cut.nodes[path.back().first].edges;
            if (path.back().second == edges.size()) {
                order.push_back(path.back().first);
                path.pop_back();
                continue;
            }
            const NodeId child = edges[path.back().second++].child;
            if (!met[child]) path.emplace_back(child, 0);
            met[child] = true;
        }
    }
    return order;
}

void set_mean_colours(CutGraph& cut) {
    constexpr int sweeps = 48;
    const std::vector<NodeId> order = masters_first(cut);
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        double change = 0;
        for (const NodeId id : order) {
            CutNode& node = cut.nodes[id];
            if (node.primitive || node.edges.empty()) continue;
            const MeanColour mean = mean_of(cut, node);
            change = std::max(change, glm::length(mean.fixed - node.mean.fixed));
            node.mean = mean;
        }
        if (change < 1e-7) break;
    }
}

void mark_solid(CutGraph& cut) {
    std::vector<std::vector<NodeId>> users(cut.nodes.size());
    std::vector<NodeId> found;
    for (NodeId id = 0; id < cut.nodes.size(); ++id) {
        cut.nodes[id].solid = false;
        for (const CutEdge& edge : cut.nodes[id].edges)
            users[edge.child].push_back(id);
        if (cut.nodes[id].primitive || cut.nodes[id].cell) found.push_back(id);
    }
    while (!found.empty()) {
        const NodeId id = found.back();
        found.pop_back();
        if (cut.nodes[id].solid) continue;
        cut.nodes[id].solid = true;
        found.insert(found.end(), users[id].begin(), users[id].end());
    }
}

CutGraph build_cut_graph(const Graph& graph, const Components& components,
                         const std::vector<ObjectBounds>& bounds) {
    Graph factored = graph;
    const std::vector<Factor> factors = take_out_factors(factored, components, bounds);
    FactorsByName factor_of;
    factor_of.reserve(graph.objects.size());
    for (ObjectId id = 0; id < graph.objects.size(); ++id)
        factor_of.emplace(graph.objects[id].name, &factors[id]);
    apply_factors(factored, factors);
    factored = merge_equivalent(drop_unreachable(std::move(factored)));

    const Components merged = strong_components(factored);
    CutGraph cut = Builder(std::move(factored), merged).build(factor_of);
    mark_textured(cut);
    weigh_by_reach(cut);
    set_mean_colours(cut);
    return cut;
}

} // namespace graftal
