#include "compiler/unfolded/drawn_bounds.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/matrix.hpp>

#include "compiler/analysis/bounding.h"
#include "compiler/analysis/contraction.h"
#include "compiler/detail/graph/edge_cell.h"
#include "compiler/graph/components.h"
#include "compiler/primitives/primitive.h"

namespace graftal {

namespace {

/// Edges of graphs with more than this many are bounded by the boxes of their children's boxes, the others by
/// what they hold.
constexpr std::size_t most_exact_edges = 5000;
/// Edges after which the control is asked: some milliseconds.
constexpr std::uint64_t edges_a_look = 5000;

Instance instance_of(const DetailEdge& edge) {
    Instance instance;
    instance.master = edge.child;
    instance.parent_from_child = edge.node_from_child;
    return instance;
}

Box box_by(const Primitive& primitive, const Affine& place, double (*support)(const Primitive&, Vec3)) {
    const Mat3 rows = glm::transpose(place.linear);
    Box box;
    for (int axis = 0; axis < 3; ++axis) {
        box.min[axis] = place.translation[axis] - support(primitive, -rows[axis]);
        box.max[axis] = place.translation[axis] + support(primitive, rows[axis]);
    }
    return box;
}

std::size_t edge_count(const DetailGraph& cut) {
    std::size_t count = 0;
    for (const DetailNode& node : cut.nodes)
        count += node.edges.size() + node.stop_edges.size();
    return count;
}

class Bounder {
  public:
    Bounder(const DetailGraph& cut, std::uint64_t most_pieces, const Control& control)
        : cut_(cut), control_(control), exact_(edge_count(cut) <= most_exact_edges),
          most_pieces_(most_pieces) {
        graph_.root = cut.root;
        for (const DetailNode& node : cut.nodes) {
            Object object;
            object.primitive = node.primitive;
            if (!node.is_combined())
                for (const std::vector<DetailEdge>* edges : {&node.edges, &node.stop_edges})
                    for (const DetailEdge& edge : *edges)
                        object.instances.push_back(instance_of(edge));
            graph_.objects.push_back(std::move(object));
        }
        for (const PrimitiveKind kind : {PrimitiveKind::sphere, PrimitiveKind::cube}) {
            Object primitive;
            primitive.primitive = kind;
            graph_.objects.push_back(std::move(primitive));
        }
        for (NodeId id = 0; id < cut.nodes.size(); ++id)
            if (cut.nodes[id].is_combined()) add_combined(id);
        for (NodeId id = 0; id < cut.nodes.size(); ++id) {
            if (!cut.nodes[id].cell) continue;
            const Box& box = cut.nodes[id].cell->box; // a cube stands for what the cell holds
            Instance about;
            about.master = static_cast<ObjectId>(cut.nodes.size() + 1);
            about.parent_from_child = Affine::translate(box.centre()) * Affine::scale(0.5 * box.size());
            graph_.objects[id].instances.push_back(about);
        }
        const std::vector<bool> ends = where_levels_end();
        for (NodeId id = 0; id < cut.nodes.size(); ++id) {
            const DetailNode& node = cut.nodes[id];
            if (node.primitive || !node.stop_edges.empty() || !(node.cullable || ends[id])) continue;
            Instance proxy;
            proxy.master = static_cast<ObjectId>(cut.nodes.size());
            proxy.parent_from_child = node.node_from_proxy;
            graph_.objects[id].instances.push_back(proxy);
        }
    }

    DrawnBounds run() {
        const std::size_t nodes = cut_.nodes.size(), first = graph_.objects.size();
        for (NodeId id = 0; id < nodes; ++id)
            for (const std::vector<DetailEdge>* edges : {&cut_.nodes[id].edges, &cut_.nodes[id].stop_edges})
                for (const DetailEdge& edge : *edges)
                    if (needs_object(edge)) add_object(edge);
        bound();
        DrawnBounds result;
        WorkMeter meter(control_, "bounding", edges_a_look);
        result.pieces = pieces_;
        std::size_t next = first;
        for (const DetailNode& node : cut_.nodes) {
            result.node.push_back(boxes_[result.node.size()]);
            for (const bool stop : {false, true}) {
                std::vector<Box>& boxes = (stop ? result.stop_edge : result.edge).emplace_back();
                for (const DetailEdge& edge : stop ? node.stop_edges : node.edges)
                    boxes.push_back(needs_object(edge) ? boxes_[next++] : box_of(edge));
                meter.add(boxes.size());
            }
        }
        return result;
    }

  private:
    void bound() {
        const Components components = strong_components(graph_);
        const Contraction contraction = decide_contraction(graph_, components, control_);
        const bool proved = contraction.verdict == Verdict::acyclic || contraction.verdict == Verdict::proved;
        boxes_ = proved ? bound_boxes(graph_, components, contraction, most_pieces_, pieces_, control_)
                        : boxes_by_balls();
    }

    /// The model contracts, but this is another graph of it, and the effort that is spent on a proof is
    /// bounded. Without one, room is left about the balls for what is drawn besides the limit set.
    std::vector<Box> boxes_by_balls() const {
        constexpr double room = 3;
        std::vector<Box> boxes(graph_.objects.size());
        const std::size_t nodes = cut_.nodes.size();
        for (NodeId id = 0; id < nodes; ++id) {
            const Ball& ball = cut_.nodes[id].ball;
            if (!(ball.radius > 0)) continue;
            boxes[id].include(ball.centre - Vec3(room * ball.radius));
            boxes[id].include(ball.centre + Vec3(room * ball.radius));
        }
        boxes[nodes] = primitive_bounds(PrimitiveKind::sphere).box;
        boxes[nodes + 1] = primitive_bounds(PrimitiveKind::cube).box;
        for (ObjectId id = 0; id < graph_.objects.size(); ++id) {
            const std::vector<Instance>& instances = graph_.objects[id].instances;
            const std::size_t inside = id < nodes ? cut_.nodes[id].edges.size() : 0;
            for (std::size_t i = inside; i < instances.size(); ++i)
                boxes[id].include(transformed(instances[i].parent_from_child, boxes[instances[i].master]));
        }
        return boxes;
    }

    /// A combined node is drawn by its edges or by its stop edges. Each are an object of their own, and the
    /// node holds both, beside its terminal or proxy.
    void add_combined(NodeId id) {
        const DetailNode& node = cut_.nodes[id];
        for (const bool stop : {false, true}) {
            Object object;
            if (!(stop && node.terminal)) object.combination = node.combination;
            for (const DetailEdge& edge : stop ? node.stop_edges : node.edges)
                object.instances.push_back(instance_of(edge));
            if (object.instances.empty()) continue;
            Instance whole;
            whole.master = graph_.add(std::move(object));
            graph_.objects[id].instances.push_back(whole);
        }
    }

    /// Nodes, by number, that may be cut because no level is left: not parts of an unending node that come
    /// without a level, such as half of its maps. That node is cut in its place.
    std::vector<bool> where_levels_end() const {
        std::vector<bool> ends(cut_.nodes.size());
        ends[cut_.root] = cut_.nodes[cut_.root].unending;
        for (const DetailNode& node : cut_.nodes)
            for (const std::vector<DetailEdge>* edges : {&node.edges, &node.stop_edges})
                for (const DetailEdge& edge : *edges)
                    if (edge.levels > 0 || !node.unending || edges == &node.stop_edges)
                        ends[edge.child] = ends[edge.child] || cut_.nodes[edge.child].unending;
        return ends;
    }

    bool needs_object(const DetailEdge& edge) const {
        return exact_ && !cut_.nodes[edge.child].primitive && !keeps_axes(edge.node_from_child.linear);
    }

    Box box_of(const DetailEdge& edge) const {
        const auto primitive = cut_.nodes[edge.child].primitive;
        if (primitive && *primitive != PrimitiveKind::plane)
            return box_of_image(*primitive, edge.node_from_child);
        return transformed(edge.node_from_child, boxes_[edge.child]);
    }

    void add_object(const DetailEdge& edge) {
        Object object;
        object.instances.push_back(instance_of(edge));
        graph_.objects.push_back(std::move(object));
    }

    const DetailGraph& cut_;
    const Control& control_;
    bool exact_;
    const std::uint64_t most_pieces_;
    std::uint64_t pieces_ = 0;
    Graph graph_;
    std::vector<Box> boxes_;
};

} // namespace

Affine graph_from_frame(const DetailNode& node, const Box& box) {
    // Sizes are kept in here, so that inverses are numbers too.
    constexpr double least_half = 1e-140, largest_half = 1e140;
    if (node.primitive || box.empty()) return {};
    const Vec3 half = 0.5 * box.max - 0.5 * box.min;
    const double size = std::clamp(std::max({half.x, half.y, half.z}), least_half, largest_half);
    return Affine::translate(box.centre()) * Affine::scale(Vec3(std::exp2(std::ceil(std::log2(size)))));
}

bool keeps_axes(const Mat3& m) {
    for (int column = 0; column < 3; ++column) {
        int along = 0;
        for (int row = 0; row < 3; ++row)
            along += m[column][row] != 0;
        if (along > 1) return false;
    }
    return true;
}

Box box_of_image(const Primitive& primitive, const Affine& place) {
    return box_by(primitive, place, primitive_support);
}

Box box_about_image(const Primitive& primitive, const Affine& place) {
    const auto reach = traits_of(primitive).reach;
    return box_by(primitive, place, reach ? reach : primitive_support);
}

DrawnBounds drawn_bounds(const DetailGraph& cut, std::uint64_t most_pieces, const Control& control) {
    return Bounder(cut, most_pieces, control).run();
}

} // namespace graftal
