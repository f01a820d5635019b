#include "runtime/trace/model/trace_model.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "compiler/detail/piece.h"
#include "compiler/detail/work.h"
#include "compiler/primitives/texture_space.h"
#include "compiler/support/stage_price.h"
#include "compiler/unfolded/drawn_bounds.h"
#include "runtime/trace/model/unroll.h"

namespace graftal {

namespace {

TraceNode::Kind kind_of(const DetailNode& node) {
    if (node.primitive) return TraceNode::Kind::primitive;
    if (node.cell) return TraceNode::Kind::run;
    if (node.unbounded) return TraceNode::Kind::unbounded;
    if (node.is_combined()) return TraceNode::Kind::combined;
    return node.sealed ? TraceNode::Kind::crushed : TraceNode::Kind::parts;
}

/// Most edges of a graph whose small groups are spelt out at each use, which takes memory.
constexpr std::size_t most_edges_spelt_out = 200'000;
/// Edges after which the flag is asked: some milliseconds.
constexpr std::uint64_t edges_a_look = 1000;

/// Fills in nodes, edges and boxes of a model.
class ModelBuilder {
  public:
    ModelBuilder(TraceModel& model, const Control& control)
        : model_(model), cancel_(control.cancel), meter_(control, "trace_model", edges_a_look),
          cut_(model.layers.cut), bounds_(model.basis->bounds) {
        std::size_t edges = 0;
        for (NodeId id = 0; id < cut_.nodes.size(); ++id) {
            model_.graph_from_frame.push_back(graph_from_frame(cut_.nodes[id], bounds_.node[id]));
            edges += cut_.nodes[id].edges.size() + cut_.nodes[id].stop_edges.size();
        }
        spells_out_groups_ = edges <= most_edges_spelt_out;
        if (spells_out_groups_) return;
        model_.edges.reserve(edges + cut_.nodes.size());
        model_.looks.reserve(edges + cut_.nodes.size());
    }

    void build() {
        add_root_edge();
        for (NodeId id = 0; id < cut_.nodes.size(); ++id)
            add_node(id);
    }

  private:
    void add_root_edge() {
        TraceEdge edge;
        edge.child = cut_.root;
        edge.to_primitive = cut_.nodes[cut_.root].primitive.has_value();
        const Affine& world_from_root = model_.graph_from_frame[cut_.root];
        set_map(edge, world_from_root, norm(world_from_root.linear));
        edge.box = bounds_.node[cut_.root];
        edge.similarity = true;
        edge.find_upright();
        add(edge, {});
    }

    /// Fills in what the edge says of its look. `holder`: of a primitive. `place`: TraceModel::places.
    void add(const TraceEdge& edge, TraceLook look, std::uint32_t holder = TraceLook::none,
             std::uint32_t place = 0) {
        look.child = edge.child;
        look.levels = edge.levels;
        look.child_has_mean = model_.source(edge.child).terminal;
        const std::uint32_t node = edge.to_primitive ? holder : edge.child;
        if (node != TraceLook::none) look.node = model_.layers.source[node];
        model_.edges.push_back(edge);
        model_.looks.push_back(look);
        model_.places.push_back(place);
        meter_.add();
    }

    void add_node(NodeId id) {
        meter_.add();
        const DetailNode& source = cut_.nodes[id];
        const Affine frame_from_graph = inverse(model_.graph_from_frame[id]);
        TraceNode node;
        node.kind = kind_of(source);
        node.primitive = source.primitive.value_or(PrimitiveKind::sphere);
        node.unending = source.unending;
        node.cullable = source.cullable;
        node.faint = source.shadowless;
        node.widens = source.widens;
        node.cut_detail = cut_detail(source, model_.projection.error_px());
        node.ball_centre = lanes_of(frame_from_graph(source.ball.centre));
        node.ball_radius = frame_from_graph.linear[0][0] * source.ball.radius;
        if (!bounds_.node[id].empty()) {
            const Box drawn = transformed(frame_from_graph, bounds_.node[id]);
            node.drawn_radius = glm::length(glm::max(glm::abs(drawn.min), glm::abs(drawn.max)));
        }
        const Affine frame_from_proxy = frame_from_graph * source.node_from_proxy;
        node.node_from_proxy = LaneMap(frame_from_proxy);
        if (!is_singular(frame_from_proxy)) node.proxy_from_node = LaneMap(inverse(frame_from_proxy));
        node.first_edge = static_cast<std::uint32_t>(model_.edges.size());
        if (node.kind == TraceNode::Kind::combined) {
            add_operands(id, node);
        } else if (node.kind == TraceNode::Kind::run) {
            add_cell(*source.cell, frame_from_graph, node);
        } else if (node.kind != TraceNode::Kind::primitive) {
            node.tree = add_edges(id, source.edges, bounds_.edge[id]);
            node.edge_count = edges_from(node.first_edge);
            if (node.kind == TraceNode::Kind::parts)
                node.stop_tree = add_edges(id, source.stop_edges, bounds_.stop_edge[id]);
            node.stop_edge_count = edges_from(node.first_edge + node.edge_count);
            while (node.endless_count < node.edge_count &&
                   cut_.nodes[model_.edges[node.first_edge + node.endless_count].child].unbounded)
                ++node.endless_count;
        }
        for (std::size_t i = node.first_edge; i < model_.edges.size(); ++i)
            node.flattest_edge = std::min(node.flattest_edge, model_.edges[i].flatness);
        model_.nodes.push_back(node);
    }

    /// Number of edges from that one on.
    std::uint32_t edges_from(std::uint32_t first) const {
        return static_cast<std::uint32_t>(model_.edges.size()) - first;
    }

    /// The tree is over what a difference takes away, as far as that is bounded. All edges of an intersection
    /// are met one by one.
    void add_operands(NodeId id, TraceNode& node) {
        const DetailNode& source = cut_.nodes[id];
        node.combination = source.combination;
        node.stops_combined = !source.terminal;
        const std::size_t apart =
            source.combination == Combination::subtract ? 1 : std::numeric_limits<std::size_t>::max();
        node.tree = add_operands(id, node, source.edges, bounds_.edge[id], apart);
        node.edge_count = edges_from(node.first_edge);
        node.stop_tree =
            add_operands(id, node, source.stop_edges, bounds_.stop_edge[id], node.stops_combined ? apart : 0);
        node.stop_edge_count = edges_from(node.first_edge + node.edge_count);
    }

    /// Adds the edges in their order, and a tree over the bounded ones from the one numbered `apart` on.
    std::uint32_t add_operands(NodeId id, TraceNode& node, const std::vector<DetailEdge>& edges,
                               const std::vector<Box>& boxes, std::size_t apart) {
        std::vector<BoxedItem> items;
        for (std::size_t i = 0; i < edges.size(); ++i) {
            const std::uint32_t number = add_part(id, {edges[i], boxes[i], static_cast<std::uint32_t>(i),
                                                       length_in_turns(edges[i].node_from_child.linear)});
            const bool endless = cut_.nodes[edges[i].child].unbounded;
            node.has_endless_operands = node.has_endless_operands || endless;
            if (i >= apart && !endless) items.emplace_back(model_.edges[number].box, number);
        }
        return build_box_tree(items, model_.boxes, cancel_);
    }

    void add_cell(const EdgeCell& cell, const Affine& frame_from_graph, TraceNode& node) {
        node.run = run_of(*cell.source);
        node.first_edge = static_cast<std::uint32_t>(model_.edges.size());
        std::vector<BoxedItem> items;
        for (std::size_t i = cell.first; i < cell.first + cell.count; ++i) {
            items.emplace_back(transformed(frame_from_graph, box_of((*cell.source->run)[i])),
                               static_cast<std::uint32_t>(i));
            meter_.add();
        }
        node.tree = build_packed_tree(items, model_.boxes, model_.packed_boxes, cancel_);
    }

    std::uint32_t run_of(const CellSource& source) {
        const auto [place, added] = run_of_.emplace(&source, static_cast<std::uint32_t>(model_.runs.size()));
        if (!added) return place->second;
        TraceRun& run = model_.runs.emplace_back();
        run.run = source.run.get();
        run.pictured = std::ranges::any_of(source.materials, [&](const std::optional<MaterialId>& material) {
            return material && model_.textures.of_material[*material];
        });
        reserve_boxes(run.run->size());
        for (std::size_t i = 0; i < source.run->size(); ++i) {
            const RunItem& item = (*source.run)[i];
            add_look(source, item.shape, item.colour, run);
            if (item.ball) add_look(source, PrimitiveKind::sphere, item.colour, run);
        }
        return place->second;
    }

    /// Makes room for the boxes of `items` more: growing in between would take twice as much.
    void reserve_boxes(std::size_t items) {
        constexpr std::size_t items_a_packed_node = 8,
                              items_a_node = 48; // a little more nodes than there are
        model_.packed_boxes.reserve(model_.packed_boxes.size() + items / items_a_packed_node +
                                    cut_.nodes.size());
        model_.boxes.reserve(model_.boxes.size() + items / items_a_node + 8 * cut_.nodes.size());
    }

    void add_look(const CellSource& source, RunShape shape, std::uint16_t colour, TraceRun& run) {
        if (run.edge_of(shape, colour) != no_edge) return;
        TraceEdge edge;
        edge.child = source.child[shape.index()];
        edge.to_primitive = true;
        TraceLook look;
        look.material = source.materials[colour];
        run.looks.push_back({shape, colour, static_cast<std::uint32_t>(model_.edges.size())});
        add(edge, look);
    }

    std::uint32_t add_edges(NodeId id, const std::vector<DetailEdge>& edges, const std::vector<Box>& boxes) {
        std::vector<std::uint32_t> numbers;
        std::set<std::pair<NodeId, std::array<double, 12>>> met; // parts that coincide are drawn once
        for (const Part& part : parts_of(edges, boxes)) {
            const auto place = std::bit_cast<std::array<double, 12>>(part.edge.node_from_child);
            if (!met.emplace(part.edge.child, place).second) continue;
            const std::uint32_t number = add_part(id, part);
            if (!cut_.nodes[part.edge.child].unbounded) numbers.push_back(number);
        }
        std::vector<BoxedItem> items = grouped_items(model_, numbers);
        return build_box_tree(items, model_.boxes, cancel_);
    }

    /// An instance and the box of what it draws, in the frame that the graph gives the node.
    struct Part {
        DetailEdge edge;
        Box box;
        std::uint32_t place = 0; ///< TraceModel::places
        double turns = 1;
        std::optional<NodeId> holder = {}; ///< of a primitive, unless it is the node itself
    };

    std::uint32_t add_part(NodeId id, const Part& part) {
        const Affine frame_from_graph = inverse(model_.graph_from_frame[id]);
        TraceEdge edge;
        edge.child = part.edge.child;
        edge.to_primitive = cut_.nodes[edge.child].primitive.has_value();
        edge.levels = part.edge.levels;
        edge.similarity = part.edge.similarity;
        TraceLook look;
        look.tint = part.edge.tint;
        look.material = part.edge.material;
        edge.turns = part.turns;
        const Affine& graph_from_child = model_.graph_from_frame[edge.child];
        set_map(edge, frame_from_graph * part.edge.node_from_child * graph_from_child,
                part.edge.stretch * graph_from_child.linear[0][0] * frame_from_graph.linear[0][0]);
        edge.find_upright();
        edge.box = transformed(frame_from_graph, part.box);
        add(edge, look, part.holder.value_or(id), part.place);
        return static_cast<std::uint32_t>(model_.edges.size() - 1);
    }

    /// The instances, with the primitives of small groups in place of the groups: a test of one more box is
    /// faster than to enter one more frame. The unbounded ones come first.
    std::vector<Part> parts_of(const std::vector<DetailEdge>& edges, const std::vector<Box>& boxes) {
        constexpr std::size_t most_parts = 4096;
        std::vector<Part> parts;
        std::uint32_t places = 0;
        for (std::size_t i = 0; i < edges.size(); ++i) {
            meter_.add();
            if (is_small_group(edges[i].child) && parts.size() + edges.size() < most_parts)
                add_group(edges[i], parts, places);
            else
                parts.push_back(
                    {edges[i], boxes[i], places++, length_in_turns(edges[i].node_from_child.linear)});
        }
        std::stable_partition(parts.begin(), parts.end(),
                              [&](const Part& part) { return cut_.nodes[part.edge.child].unbounded; });
        return parts;
    }

    /// A handful of primitives, which is never cut.
    bool is_small_group(NodeId id) const {
        const DetailNode& node = cut_.nodes[id];
        return spells_out_groups_ && !node.primitive && !node.cell && !node.unending && !node.unbounded &&
               !node.sealed && !node.cullable && !node.is_combined();
    }

    /// The group's primitives are in one place.
    void add_group(const DetailEdge& group, std::vector<Part>& parts, std::uint32_t& places) const {
        const std::uint32_t place = places++;
        for (const DetailEdge& member : cut_.nodes[group.child].edges) {
            DetailEdge edge = member;
            edge.node_from_child = group.node_from_child * member.node_from_child;
            edge.tint = group.tint * member.tint;
            if (!edge.material) edge.material = group.material;
            edge.similarity = group.similarity && member.similarity;
            edge.stretch =
                edge.similarity ? group.stretch * member.stretch : norm(edge.node_from_child.linear);
            edge.levels = group.levels + member.levels;
            const auto primitive = cut_.nodes[edge.child].primitive;
            if (primitive)
                parts.push_back({edge, box_of_image(*primitive, edge.node_from_child), place,
                                 length_in_turns(member.node_from_child.linear), group.child});
            else if (is_small_group(edge.child))
                add_group(edge, parts, places);
            else
                parts.push_back(
                    {edge, transformed(edge.node_from_child, bounds_.node[edge.child]), places++, 1});
        }
    }

    static void set_map(TraceEdge& edge, const Affine& parent_from_child, double stretch) {
        edge.parent_from_child = LaneMap(parent_from_child);
        const Vec3 sigma = singular_values(parent_from_child.linear);
        edge.flatness = sigma.x > 0 ? sigma.z / sigma.x : 0;
        if (!is_singular(parent_from_child)) edge.child_from_parent = LaneMap(inverse(parent_from_child));
        edge.stretch = stretch;
        edge.growth = 1 / stretch;
    }

    TraceModel& model_;
    const CancelFlag& cancel_;
    WorkMeter meter_;
    bool spells_out_groups_ = true;
    const DetailGraph& cut_;
    const DrawnBounds& bounds_;
    std::map<const CellSource*, std::uint32_t> run_of_;
};

/// Least detail of a unit: at the far end of the model, were it out of the picture.
double least_detail(const TraceModel& model) {
    const DetailGraph& cut = model.prepared.cut;
    const Ball& ball = cut.nodes[cut.root].ball;
    const Camera& camera = model.view.camera;
    const double reach = glm::distance(ball.centre, camera.location) + 2 * ball.radius;
    const Ball far{camera.location + reach * camera.direction, 0};
    return model.projection.detail_per_unit(far) / Projection::coarser_out_of_sight;
}

/// TraceModel::even.
bool is_even(const TraceModel& model) {
    // Where nothing is culled, only what is flat is drawn wider than it is.
    constexpr double flat = 1e-3;
    const auto has_flat_proxy = [](const TraceNode& node) {
        const Vec3 sigma = singular_values(linear_of(node.node_from_proxy));
        return node.stop_tree == no_tree && !(sigma.z > flat * sigma.x);
    };
    const auto is_plain = [&](const TraceNode& node) {
        const bool widens = node.widens || node.faint;
        if (node.kind == TraceNode::Kind::primitive)
            return !is_endless(node) && !(widens && model.projection.culls());
        return node.kind == TraceNode::Kind::parts &&
               !(widens && (model.projection.culls() || has_flat_proxy(node)));
    };
    const auto is_plain_edge = [](const TraceEdge& edge) {
        return edge.to_primitive ? edge.flatness > flattest_placement : edge.upright;
    };
    return !model.has_shells && !model.clear_texels && std::ranges::all_of(model.nodes, is_plain) &&
           std::ranges::all_of(model.edges, is_plain_edge);
}

/// Units of work that making a model may take, by the units of a second; no more than usual.
std::uint64_t share_of(double work_seconds, double units_a_second, std::uint64_t usual) {
    constexpr double share = 0.1;
    return static_cast<std::uint64_t>(
        std::min(share * work_seconds * units_a_second, static_cast<double>(usual)));
}

/// Sizes by node of the cut; none if rays come through everywhere.
std::vector<ShellSizes> found_shell_sizes(TraceModel& model, const Control& control) {
    const DetailGraph& cut = model.prepared.cut;
    // Sizes are asked for by octaves. An eighth of one tells them apart, and nodes of all sizes share kinds.
    constexpr int grain = PieceKind::steps_an_octave / 8;
    Weights weights(
        cut,
        {.error_px = model.projection.error_px(),
         .grain = grain,
         .most_visits = share_of(model.options.work_seconds, WorkRates::kinds, WeightOptions::usual_visits)},
        control);
    Piece root;
    root.node = cut.root;
    root.steps = model.prepared.root_steps;
    std::vector<ShellSizes> sizes;
    if (weights.of(kind_of(cut, model.projection, root)).crowded) {
        sizes.resize(cut.nodes.size());
        for (const NodeId source : model.layers.source)
            if (!cut.nodes[source].primitive) sizes[source] = weights.shell_sizes(source, root.steps);
    }
    model.weighed = weights.visits();
    return sizes;
}

/// Where copies lie in each other so often that rays would not come through.
void find_shells(TraceModel& model, const Control& control) {
    if (!model.projection.culls()) return;
    if (std::ranges::any_of(model.prepared.cut.nodes, &DetailNode::is_combined)) return;
    std::optional<std::vector<ShellSizes>>& known = model.basis->shell_sizes;
    const auto by_error = [](const DetailNode& node) { return node.terminal_px > 0; };
    if (!known || std::ranges::any_of(model.prepared.cut.nodes, by_error))
        known = found_shell_sizes(model, control);
    const std::vector<ShellSizes>& sizes = *known;
    if (sizes.empty()) return;
    for (std::size_t i = 0; i < model.nodes.size(); ++i) {
        model.nodes[i].shell = sizes[model.layers.source[i]];
        model.has_shells = model.has_shells || model.nodes[i].shell.any();
    }
}

/// Most work of one shell: there may be several, and they may be made anew at another error.
std::uint64_t most_shell_work(const DetailOptions& options) {
    constexpr double share = 0.15, least = 1e6; // with less there is hardly one
    const double seconds = options.culls() ? std::min(share * options.work_seconds, 1e6) : 1e6;
    return static_cast<std::uint64_t>(std::max(least, seconds * WorkRates::shell_points));
}

} // namespace

void TraceEdge::find_upright() {
    const auto scales = [](const Mat3& m) { return m == Mat3(m[0][0]) && m[0][0] > 0; };
    const Mat3 linear = parent_from_child.affine().linear, inverse = child_from_parent.affine().linear;
    upright = similarity && scales(linear) && scales(inverse);
}

std::uint32_t TraceRun::edge_of(RunShape shape, std::uint16_t colour) const {
    for (const Look& look : looks)
        if (look.shape == shape && look.colour == colour) return look.edge;
    return no_edge;
}

TraceBasis::TraceBasis(const PreparedGraph& prepared, double work_seconds, const CancelFlag& cancel)
    : layers(layered(prepared.cut, prepared.root_steps)),
      bounds(drawn_bounds(layers.cut, share_of(work_seconds, 1 / StagePrice::piece, most_pieces),
                          {cancel, {}})) {}

TraceModel::TraceModel(std::shared_ptr<const PreparedGraph> ready, const View& seen,
                       const DetailOptions& cut_options, ModelTextures read_textures,
                       std::shared_ptr<TraceBasis> known_basis, const CancelFlag& cancel)
    : shared(std::move(ready)), prepared(*shared),
      basis(known_basis ? std::move(known_basis)
                        : std::make_shared<TraceBasis>(prepared, cut_options.work_seconds, cancel)),
      layers(basis->layers), view(seen), options(cut_options),
      projection(view, options, options.error_px, nearest_to_eye(prepared.cut)),
      meshes(prepared, most_shell_work(options)), textures(std::move(read_textures)) {
    least_detail_per_unit = least_detail(*this);
    const DetailNode& root = prepared.cut.nodes[prepared.cut.root];
    for (const DetailNode& node : prepared.cut.nodes)
        if (node.primitive && node.primitive != PrimitiveKind::plane)
            widest = std::max(widest, widened_reach(*node.primitive));
    if (root.widens) most_half_width = projection.most_half_width(root.ball);
    textures.of_material.resize(prepared.cut.materials.size());
    for (const std::shared_ptr<const Texture>& texture : textures.of_material)
        clear_texels = clear_texels || (texture && texture->coverage < 1);
    const Control control{cancel, {}};
    ModelBuilder(*this, control).build();
    near_enough = NearEnough(prepared, *basis, most_half_width, projection.error_px());
    find_shells(*this, control);
    add_specks(*this);
    add_unrollings(*this, cancel);
    even = is_even(*this);
    if (cancel.raised()) throw Cancelled();
    if (!even) return;
    add_even_parts(*this);
    add_even_triangles(*this);
}

const SelfShadows& TraceModel::self_shadows(const CancelFlag& cancel) const {
    return basis->self_shadows.get([&] {
        return measure_self_shadows(prepared.cut, prepared.symmetry, prepared.root_steps, view,
                                    options.limit_normals, options.light_steps,
                                    self_shadow_work(options.work_seconds), cancel);
    });
}

} // namespace graftal
