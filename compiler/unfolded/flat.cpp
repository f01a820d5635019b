#include "compiler/unfolded/flat.h"

#include <cmath>
#include <limits>
#include <unordered_map>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "compiler/detail/graph/edge_cell.h"
#include "compiler/detail/graph/piece_kind.h"
#include "compiler/detail/least_width.h"
#include "compiler/primitives/texture_space.h"

namespace graftal {

namespace {

std::array<float, 12> floats_of(const Affine& map) {
    std::array<float, 12> floats;
    for (std::size_t i = 0; i < 12; ++i)
        floats[i] = static_cast<float>(i < 9 ? map.linear[static_cast<int>(i / 3)][static_cast<int>(i % 3)]
                                             : map.translation[static_cast<int>(i - 9)]);
    return floats;
}

class Flattening {
  public:
    Flattening(const DetailGraph& cut, const DrawnBounds& bounds, std::size_t most_edges)
        : cut_(cut), bounds_(bounds), most_edges_(most_edges) {}

    std::optional<FlatGraph> run(double error_px) {
        for (NodeId id = 0; id < cut_.nodes.size(); ++id)
            graph_from_frame_.push_back(graph_from_frame(cut_.nodes[id], bounds_.node[id]));
        flat_.root = cut_.root;
        flat_.world_from_root = graph_from_frame_[cut_.root];
        for (NodeId id = 0; id < cut_.nodes.size(); ++id) {
            add_node(id, error_px);
            if (!fits_) return std::nullopt;
        }
        mark_wide();
        return std::move(flat_);
    }

  private:
    void add_node(NodeId id, double error_px) {
        const DetailNode& node = cut_.nodes[id];
        const Affine frame_from_graph = inverse(graph_from_frame_[id]);
        fits_ = fits_ && flat_.edges.size() + edge_count(node, false) + node.stop_edges.size() <= most_edges_;
        if (!fits_) return;
        FlatNode flat;
        if (node.primitive) flat.primitive = number_of(*node.primitive);
        flat.unending = node.unending && !node.unbounded;
        flat.terminal = node.terminal;
        flat.faint = node.shadowless;
        flat.diameter = static_cast<float>(2 * frame_from_graph.linear[0][0] * node.ball.radius);
        const Vec3 centre = frame_from_graph(node.ball.centre);
        for (int axis = 0; axis < 3; ++axis)
            flat.centre[static_cast<std::size_t>(axis)] = static_cast<float>(centre[axis]);
        flat.reach = reach_of(node, transformed(frame_from_graph, bounds_.node[id]), centre);
        if (node.cullable && !node.primitive && !node.unbounded)
            flat.cut_detail = static_cast<float>(cut_detail(node, error_px));
        flat.frame_from_proxy = floats_of(frame_from_graph * node.node_from_proxy);
        flat.mean = Paint(node.mean);
        flat.proxy = Paint(colour_of_proxy(node));
        flat.finish = node.finish.value_or(flat_none);
        flat.first_edge = static_cast<std::uint32_t>(flat_.edges.size());
        for (const bool stop : {false, true}) {
            std::size_t next = 0;
            for_each_edge(node, stop, [&](const DetailEdge& edge) {
                const auto& boxes = (stop ? bounds_.stop_edge : bounds_.edge)[id];
                const Box box = node.cell && !stop
                                    ? box_of_image(*cut_.nodes[edge.child].primitive, edge.node_from_child)
                                    : boxes[next++];
                add_edge(edge, frame_from_graph,
                         cut_.nodes[edge.child].unbounded ? endless_ : transformed(frame_from_graph, box));
            });
            (stop ? flat.stop_edge_count : flat.edge_count) =
                static_cast<std::uint32_t>(flat_.edges.size()) - flat.first_edge - flat.edge_count;
        }
        flat_.nodes.push_back(flat);
    }

    /// `box` and `centre`: in the node's frame, of what it draws and of its ball.
    static float reach_of(const DetailNode& node, const Box& box, Vec3 centre) {
        if (node.unbounded) return flat_endless;
        if (node.primitive) return static_cast<float>(node.ball.radius);
        if (box.empty()) return 0;
        constexpr double rounding = 1 + 1e-6;
        return static_cast<float>(rounding * glm::length(glm::max(box.max - centre, centre - box.min)));
    }

    /// Parts that are drawn wider than they are make what holds them wider, too.
    void mark_wide() {
        std::vector<std::vector<std::uint32_t>> users(flat_.nodes.size());
        std::vector<std::uint32_t> wide;
        for (std::uint32_t id = 0; id < flat_.nodes.size(); ++id) {
            FlatNode& node = flat_.nodes[id];
            node.widens = node.faint;
            for (std::uint32_t i = 0; i < node.edge_count + node.stop_edge_count; ++i) {
                const FlatEdge& edge = flat_.edges[node.first_edge + i];
                users[edge.child].push_back(id);
                node.widens |= edge.crushes;
            }
            if (node.widens) wide.push_back(id);
        }
        while (!wide.empty()) {
            const std::uint32_t id = wide.back();
            wide.pop_back();
            for (const std::uint32_t user : users[id])
                if (std::exchange(flat_.nodes[user].widens, 1) == 0) wide.push_back(user);
        }
    }

    void add_edge(const DetailEdge& edge, const Affine& frame_from_graph, const Box& box) {
        const Affine& graph_from_child = graph_from_frame_[edge.child];
        const Affine parent_from_child = frame_from_graph * edge.node_from_child * graph_from_child;
        const bool endless = cut_.nodes[edge.child].unbounded;
        fits_ = fits_ && !(endless && is_singular(parent_from_child));
        if (!fits_) return;
        const bool crushes = !endless && is_singular(parent_from_child, flattest_placement);
        FlatEdge flat;
        flat.child = edge.child;
        flat.crushes = crushes;
        const Mat3 linear = crushes ? parent_from_child.linear : inverse(parent_from_child).linear;
        flat.levels = edge.levels;
        flat.material = edge.material.value_or(flat_none);
        flat.stretch =
            static_cast<float>(edge.stretch * graph_from_child.linear[0][0] * frame_from_graph.linear[0][0]);
        flat.turns = static_cast<float>(length_in_turns(edge.node_from_child.linear));
        flat.tint = Paint(edge.tint);
        for (std::size_t i = 0; i < 9; ++i)
            flat.linear[i] = FloatPair(linear[static_cast<int>(i / 3)][static_cast<int>(i % 3)]);
        for (std::size_t i = 0; i < 3; ++i)
            flat.origin[i] = FloatPair(parent_from_child.translation[static_cast<int>(i)]);
        flat.box = floats_of(box);
        flat_.edges.push_back(flat);
    }

    std::uint32_t number_of(const Primitive& primitive) {
        const auto [place, added] =
            numbers_.emplace(primitive, static_cast<std::uint32_t>(flat_.primitives.size()));
        if (added) flat_.primitives.push_back(primitive);
        return place->second;
    }

    const DetailGraph& cut_;
    const DrawnBounds& bounds_;
    const std::size_t most_edges_;
    static constexpr double half_endless = flat_endless;
    const Box endless_{Vec3(-half_endless), Vec3(half_endless)};
    FlatGraph flat_;
    std::vector<Affine> graph_from_frame_;
    std::unordered_map<Primitive, std::uint32_t> numbers_;
    bool fits_ = true;
};

} // namespace

Mat3 linear_of(const FlatEdge& edge) {
    Mat3 linear;
    for (std::size_t i = 0; i < 9; ++i)
        linear[static_cast<int>(i / 3)][static_cast<int>(i % 3)] = edge.linear[i].value();
    return linear;
}

std::array<float, 6> floats_of(const Box& box) {
    std::array<float, 6> floats;
    for (int axis = 0; axis < 3; ++axis) {
        constexpr float infinity = std::numeric_limits<float>::infinity();
        const auto k = static_cast<std::size_t>(axis);
        floats[k] = std::nextafter(static_cast<float>(box.min[axis]), -infinity);
        floats[k + 3] = std::nextafter(static_cast<float>(box.max[axis]), infinity);
    }
    return floats;
}

Box box_of(const FlatEdge& edge) {
    return {{edge.box[0], edge.box[1], edge.box[2]}, {edge.box[3], edge.box[4], edge.box[5]}};
}

Affine frame_from_proxy(const FlatNode& node) {
    Affine map;
    for (std::size_t i = 0; i < 12; ++i)
        (i < 9 ? map.linear[static_cast<int>(i / 3)][static_cast<int>(i % 3)]
               : map.translation[static_cast<int>(i - 9)]) = node.frame_from_proxy[i];
    return map;
}

Affine parent_from_child(const FlatEdge& edge) {
    Affine map;
    map.linear = linear_of(edge);
    if (edge.crushes == 0) map.linear = inverse(Affine{map.linear, Vec3(0.0)}).linear;
    for (int axis = 0; axis < 3; ++axis)
        map.translation[axis] = edge.origin[static_cast<std::size_t>(axis)].value();
    return map;
}

std::optional<FlatGraph> flat_graph(const LayeredGraph& layers, const DrawnBounds& bounds, double error_px,
                                    std::size_t most_edges) {
    return Flattening(layers.cut, bounds, most_edges).run(error_px);
}

} // namespace graftal
