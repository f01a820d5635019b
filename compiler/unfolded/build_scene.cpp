#include "compiler/unfolded/build_scene.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include <fmt/format.h>

#include "compiler/detail/baked.h"
#include "compiler/detail/graph/piece_kind.h"
#include "compiler/detail/least_width.h"
#include "compiler/detail/placed_set.h"
#include "compiler/detail/projection.h"
#include "compiler/graph/path.h"
#include "compiler/primitives/tessellate.h"
#include "compiler/primitives/texture_space.h"
#include "compiler/support/stretch.h"

namespace graftal {

namespace {

/// A node is shared where the errors that measure a unit differ by no more than this factor over it.
constexpr double most_unequal = 1.5;
/// Least number of errors that a node measures to be worth a copy of its own.
constexpr double least_unshared = 8;
/// Steps an octave in which sizes are told apart: what is culled has to be small enough, meshes nearly so.
constexpr int culling_grain = 64;
constexpr int meshing_grains[] = {2, 1, 0};
/// Steps an octave to which sizes that the view gives are rounded up. Parts at distances of all kinds then
/// share what is below them.
constexpr int view_grain = 2;
/// A part without thickness gets this share of its size, where nothing is culled.
constexpr double given_thickness = 1e-4;
constexpr std::size_t most_crushed_leaves = 1'000'000;
constexpr std::int32_t largest_size_step = 1 << 24;

/// A node at its place in the world, if it has one of its own.
struct PlacedNode {
    Affine world_from_node;
    double scale = 1;
};

struct SceneTask {
    SceneId id = 0;
    PieceKind key;
    std::optional<PlacedNode> placed;
};

/// Least number of nodes that differ by their levels alone, where nothing is culled.
std::size_t least_nodes(const PreparedGraph& prepared) {
    const std::vector<DetailNode>& nodes = prepared.cut.nodes;
    if (!nodes[prepared.cut.root].unending || prepared.root_steps == unlimited_steps) return 0;
    // The leaves below a singular map are counted one by one.
    return std::ranges::any_of(nodes, &DetailNode::sealed) ? 0 : prepared.root_steps;
}

/// Thrown where a scene gets too large; caught by build_scene().
struct SceneTooLarge {};

class SceneBuilder {
  public:
    SceneBuilder(const PreparedGraph& prepared, const View& view, const DetailOptions& detail,
                 SceneMeshes meshes, int grain, const SceneLimits& limits, const Control& control)
        : cut_(prepared.cut), prepared_(prepared), detail_(positive_error(detail)),
          projection_(view, detail_, detail_.error_px, nearest_to_eye(prepared.cut)), culls_(detail.culls()),
          grain_(meshes == SceneMeshes::shared && !culls_ ? 0 : grain), limits_(limits),
          meter_(control, "scene", 100'000) {
        scene_.materials = cut_.materials;
        scene_.bounds = prepared.bounds;
        scene_.culled = culls_;
        scene_.one_mesh = meshes == SceneMeshes::shared && !culls_;
        if (!detail_.error_world)
            scene_.tolerance_errors = tessellation_tolerance(detail_.error_px) / detail_.error_px;
    }

    UnfoldedScene build() {
        scene_.nodes.emplace_back();
        scene_.nodes[0].name = cut_.nodes[cut_.root].name;
        DetailEdge to_root;
        to_root.child = cut_.root;
        to_root.similarity = true;
        const SceneTask world{0, {cut_.root, prepared_.root_steps, 0}, PlacedNode{}};
        add_part(world, to_root, 1);
        while (!tasks_.empty()) {
            const SceneTask task = tasks_.back();
            tasks_.pop_back();
            fill(task);
        }
        if (scene_.one_mesh) refine_shared();
        return std::move(scene_);
    }

  private:
    static DetailOptions positive_error(DetailOptions detail) {
        if (detail.culls()) return detail;
        detail.error_world.reset();
        detail.error_px = DetailOptions().error_px;
        return detail;
    }

    double errors_per_unit(const Ball& ball) const {
        return detail_.error_world ? 1 / *detail_.error_world : projection_.detail_range(ball).most;
    }

    bool is_shared(const DetailNode& node, const Ball& ball) const {
        if (grain_ == 0 || detail_.error_world) return true;
        const Projection::DetailRange range = projection_.detail_range(ball);
        const bool even = range.most <= most_unequal * range.least;
        // Without culling only meshes differ, which may be too fine.
        return even || !culls_ || (!node.unbounded && 2 * ball.radius * range.most <= least_unshared);
    }

    /// The step of a node of which `errors` measure a unit in the view.
    std::int32_t size_step(double errors) const {
        if (grain_ == 0) return 0;
        const int grain = detail_.error_world ? grain_ : view_grain;
        const double rounded = std::ceil(std::log2(std::max(errors, 1e-300)) * grain - 1e-6) / grain;
        const double step = std::floor(rounded * grain_ + 1e-6);
        return static_cast<std::int32_t>(std::clamp<double>(step, -largest_size_step, largest_size_step));
    }

    double errors_of(std::int32_t step) const {
        if (grain_ == 0) return whole_;
        return std::exp2(static_cast<double>(step) / grain_);
    }

    /// Errors that measure a unit of the task's node.
    double errors_of(const SceneTask& task) const {
        return task.placed ? errors_per_unit(world_ball(task.key.node, *task.placed))
                           : errors_of(task.key.unit_step);
    }

    Ball world_ball(NodeId node, const PlacedNode& placed) const {
        const Ball& ball = cut_.nodes[node].ball;
        return {placed.world_from_node(ball.centre), placed.scale * ball.radius};
    }

    SceneId add_node(const std::string& name) {
        if (scene_.nodes.size() >= limits_.nodes) throw SceneTooLarge();
        scene_.nodes.emplace_back().name = name;
        return static_cast<SceneId>(scene_.nodes.size() - 1);
    }

    SceneId leaf(const Primitive& primitive, double errors) {
        const SceneShape shape = scene_.shape_for(primitive, errors);
        const auto known = scene_.leaves.find(shape);
        if (known != scene_.leaves.end()) return known->second;
        const SceneId id = add_node(std::string(name_of(primitive.kind())));
        scene_.nodes[id].shape = static_cast<std::uint32_t>(scene_.shapes.size());
        scene_.shapes.push_back(shape);
        scene_.leaves.emplace(shape, id);
        return id;
    }

    /// The scene's node for a key, made at its first use. Requires a node that is no primitive.
    SceneId shared(const PieceKind& key) {
        const auto known = shared_.find(key);
        if (known != shared_.end()) return known->second;
        const SceneId id = add_node(cut_.nodes[key.node].name);
        shared_.emplace(key, id);
        tasks_.push_back({id, key, std::nullopt});
        return id;
    }

    SceneId unshared(const PieceKind& key, const PlacedNode& placed) {
        const SceneId id = add_node(cut_.nodes[key.node].name);
        tasks_.push_back({id, key, placed});
        return id;
    }

    void push_part(SceneId node, ScenePart part) {
        if (++parts_ > limits_.parts) throw SceneTooLarge();
        meter_.add();
        scene_.nodes[node].parts.push_back(part);
    }

    /// `errors`: that measure a unit of the task's node.
    void add_part(const SceneTask& task, const DetailEdge& edge, double errors) {
        const DetailNode& child = cut_.nodes[edge.child];
        if (child.primitive && *child.primitive == PrimitiveKind::plane) {
            scene_.left_out_planes = true;
            return;
        }
        ScenePart part;
        part.node_from_part = edge.node_from_child;
        part.tint = edge.tint;
        part.material = edge.material;
        PieceKind key = without_idle_levels(cut_, {edge.child, steps_below(task.key.steps, edge), 0});
        if (task.placed) {
            PlacedNode placed;
            placed.world_from_node = task.placed->world_from_node * edge.node_from_child;
            placed.scale = size_below(task.placed->scale, edge, placed.world_from_node.linear);
            const Ball ball = world_ball(edge.child, placed);
            const double child_errors = placed.scale * errors_per_unit(ball);
            if (!std::isfinite(whole_) || task.id == 0) whole_ = child_errors;
            if (child.primitive)
                part.node = leaf(*child.primitive, child_errors);
            else if (!is_shared(child, ball))
                part.node = unshared(key, placed);
            else {
                key.unit_step = size_step(child_errors);
                part.node = shared(key);
            }
        } else if (child.primitive) {
            part.node = leaf(*child.primitive, errors * edge.stretch);
        } else {
            key.unit_step = step_below(task.key.unit_step, edge);
            part.node = shared(key);
        }
        if (child.primitive) part.turns = length_in_turns(edge.node_from_child.linear);
        push_part(task.id, part);
    }

    /// Steps of stretches that are rounded down get smaller round every cycle, so that this ends.
    std::int32_t step_below(std::int32_t step, const DetailEdge& edge) const {
        if (grain_ == 0) return 0;
        const double stretch = cut_.contractive ? edge.stretch : edge.volume_stretch;
        const double change = std::floor(std::log2(std::max(stretch, 1e-300)) * grain_ + 1e-6);
        return static_cast<std::int32_t>(
            std::clamp<double>(step + change, -largest_size_step, largest_size_step));
    }

    void fill(const SceneTask& task) {
        const DetailNode& node = cut_.nodes[task.key.node];
        scene_.nodes[task.id].whole = node.mean;
        double errors = errors_of(task);
        if (task.placed) errors *= task.placed->scale;
        if (node.sealed) return fill_crushed(task, errors);
        const double detail = culls_ && !node.unbounded ? 2 * node.ball.radius * errors
                                                        : std::numeric_limits<double>::infinity();
        const bool cut = is_cut(node, task.key.steps, detail, detail_.error_world ? 0 : detail_.error_px);
        if (node.cell && !cut) return fill_cell(task, node, errors);
        const std::vector<DetailEdge>& edges = followed_edges(node, cut);
        if (edges.empty() && cut) return add_proxy(task.id, node, errors);
        if (cut && node.terminal) scene_.nodes[task.id].mean = node.mean;
        for (const DetailEdge& edge : edges)
            add_part(task, edge, errors);
    }

    void fill_cell(const SceneTask& task, const DetailNode& node, double errors) {
        node.cell->for_each([&](const CellEdge& edge) {
            if (++parts_ > limits_.parts) throw SceneTooLarge();
            meter_.add();
            leaf(edge.shape.primitive(), errors * edge.stretch);
        });
        scene_.nodes[task.id].cell = node.cell;
        scene_.nodes[task.id].errors_per_unit = errors;
    }

    /// Half of the width that parts without width of their own get at least; 0: nothing is culled.
    double half_width(double errors) const {
        if (!culls_) return 0;
        const double share =
            detail_.error_world ? 1 : std::min(least_half_width_px, detail_.error_px) / detail_.error_px;
        return share / errors;
    }

    void add_proxy(SceneId id, const DetailNode& node, double errors) {
        ScenePart part;
        part.node_from_part = node.node_from_proxy;
        const double width = half_width(errors);
        if (node.shadowless && width > 0)
            part.node_from_part = widened(PrimitiveKind::sphere, node.node_from_proxy, width);
        part.node = leaf(PrimitiveKind::sphere, errors * largest_stretch(part.node_from_part.linear));
        scene_.nodes[id].mean = colour_of_proxy(node);
        push_part(id, part);
    }

    /// Leaf by leaf: a map without thickness is none that formats could place things by.
    void fill_crushed(const SceneTask& task, double errors) {
        struct Crushed {
            NodeId node;
            std::uint32_t steps;
            Affine place;
            double scale;
            SceneLook look;
        };
        std::size_t leaves = 0;
        // Leaves that a singular map crushes pile up: one of those that lie alike is enough.
        PlacedSet seen(std::max(cut_.nodes[task.key.node].ball.radius, 1e-280));
        std::vector<Crushed> stack{{task.key.node, task.key.steps, {}, 1, {}}};
        const auto add = [&](const Crushed& at, const Primitive& primitive, const Affine& place,
                             const MeanColour& mean) {
            if (++leaves > most_crushed_leaves) throw SceneTooLarge();
            const double size = largest_stretch(place.linear);
            if (!(size > 0) && !culls_) return;
            const double least = std::max(half_width(errors), given_thickness * size);
            const DrawnLeaf drawn = drawn_leaf(primitive, place, false, least);
            const Affine mark = culls_ && drawn.half_width > 0
                                    ? Affine::scale(Vec3(cut_.nodes[task.key.node].ball.radius)) *
                                          speck_mark(drawn.place, drawn.half_width)
                                    : drawn.place;
            if (!seen.insert(static_cast<std::uint32_t>(primitive.kind()), mark)) return;
            ScenePart inner;
            inner.node_from_part = drawn.place;
            inner.node = leaf(primitive, errors * largest_stretch(drawn.place.linear));
            ++scene_.thickened;
            const SceneId holder = add_node(cut_.nodes[at.node].name);
            scene_.nodes[holder].mean = mean;
            push_part(holder, inner);
            ScenePart outer;
            outer.node = holder;
            outer.tint = at.look.tint;
            outer.material = at.look.material;
            push_part(task.id, outer);
        };
        while (!stack.empty()) {
            const Crushed at = stack.back();
            stack.pop_back();
            const DetailNode& node = cut_.nodes[at.node];
            if (node.primitive) {
                if (*node.primitive == PrimitiveKind::plane)
                    scene_.left_out_planes = true;
                else
                    add(at, *node.primitive, at.place, {Rgb(0.0), 1});
                continue;
            }
            const double detail =
                culls_ ? 2 * node.ball.radius * at.scale * errors : std::numeric_limits<double>::infinity();
            const bool cut = is_cut(node, at.steps, detail, detail_.error_world ? 0 : detail_.error_px);
            if (followed_edges(node, cut).empty() && cut) {
                add(at, PrimitiveKind::sphere, at.place * node.node_from_proxy, colour_of_proxy(node));
                continue;
            }
            const std::size_t first = stack.size();
            for_each_edge(node, cut, [&](const DetailEdge& edge) {
                Crushed below{edge.child, steps_below(at.steps, edge), at.place * edge.node_from_child, 1,
                              at.look};
                below.scale = size_below(at.scale, edge, below.place.linear);
                below.look.descend(look_step(cut_, node, cut, edge));
                stack.push_back(below);
            });
            std::reverse(stack.begin() + static_cast<std::ptrdiff_t>(first), stack.end());
            meter_.add();
        }
    }

    /// Gives each shared shape the mesh that suits it where it is largest.
    void refine_shared() {
        if (!sort_masters_first(scene_)) return; // whoever asked is told
        std::vector<double> largest(scene_.nodes.size(), 0);
        largest[0] = whole_;
        for (auto id = scene_.masters_first.rbegin(); id != scene_.masters_first.rend(); ++id)
            for_each_part(scene_, scene_.nodes[*id], [&](const ScenePart& part) {
                largest[part.node] =
                    std::max(largest[part.node], largest[*id] * largest_stretch(part.node_from_part.linear));
            });
        for (SceneId id = 0; id < scene_.nodes.size(); ++id)
            if (scene_.nodes[id].shape) {
                SceneShape& shape = scene_.shapes[*scene_.nodes[id].shape];
                shape.fineness = scene_.fineness(shape.primitive, largest[id]);
            }
    }

    const DetailGraph& cut_;
    const PreparedGraph& prepared_;
    const DetailOptions detail_;
    const Projection projection_;
    const bool culls_;
    const int grain_; ///< 0: sizes are not told apart
    const SceneLimits limits_;
    WorkMeter meter_;
    UnfoldedScene scene_;
    std::unordered_map<PieceKind, SceneId, PieceKindHash> shared_; ///< sizes in steps of the grain
    std::vector<SceneTask> tasks_;
    std::size_t parts_ = 0;
    double whole_ = std::numeric_limits<double>::infinity(); ///< errors that measure a unit of the world
};

} // namespace

std::optional<UnfoldedScene> build_scene(const PreparedGraph& prepared, const View& view,
                                         const DetailOptions& detail, SceneMeshes meshes, Span model,
                                         const SceneLimits& limits, const Control& control,
                                         Diagnostics& diagnostics) {
    const auto attempt = [&](int grain) -> std::optional<UnfoldedScene> {
        try {
            UnfoldedScene scene =
                SceneBuilder(prepared, view, detail, meshes, grain, limits, control).build();
            if (sort_masters_first(scene)) return scene;
        } catch (const SceneTooLarge&) {
        }
        return std::nullopt;
    };
    if (const std::size_t least = least_nodes(prepared); !detail.culls() && least > limits.nodes) {
        diagnostics
            .error(model, fmt::format("this model has {} levels, each with a part of its own, and {} are the "
                                      "most: too many to export",
                                      least, limits.nodes))
            .with_hint("leave out small parts with '--error PX', or set a smaller depth with '--steps N'");
        return std::nullopt;
    }
    std::optional<UnfoldedScene> scene;
    if (detail.culls())
        scene = attempt(culling_grain);
    else
        for (const int grain : meshing_grains)
            if (!scene) scene = attempt(grain);
    if (!scene)
        diagnostics
            .error(model, fmt::format("this model has more than {} parts that differ, or more than {} "
                                      "objects: too many to export",
                                      limits.parts, limits.nodes))
            .with_hint("leave out more with a larger --error, or set a depth with '--steps N'");
    return scene;
}

} // namespace graftal
