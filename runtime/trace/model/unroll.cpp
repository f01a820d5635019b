#include "runtime/trace/model/unroll.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "compiler/unfolded/drawn_bounds.h"

namespace graftal {

namespace {

/// Parts of one unrolling: what goes into the first and second caches.
constexpr std::size_t most_parts = 512;
/// Primitives of one that is cut, and of all.
constexpr std::size_t most_leaves = 1024, most_leaves_in_all = 8192;
/// Unrollings of one node, and groups in groups that are passed over between two of them.
constexpr std::size_t most_unrollings = 6;
constexpr int most_groups = 8;
/// Parts of a part, to find its box.
constexpr std::uint32_t most_looked_at = 64;
/// Parts of all unrollings: some MiB, in some milliseconds.
constexpr std::size_t most_in_all = 8192;
/// Parts made in all, with those that are taken back, and smaller parts looked at to find their boxes.
constexpr std::size_t most_made = 16 * most_in_all, most_looks = 1 << 15;

class Unroller {
  public:
    Unroller(TraceModel& model, const CancelFlag& cancel)
        : model_(model), cancel_(cancel), most_edges_(model.edges.size() + most_in_all) {}

    void run() {
        for (const std::uint32_t number : nodes_by_distance()) {
            if (cancel_.raised()) throw Cancelled();
            unroll(model_.nodes[number]);
        }
    }

  private:
    struct Parts {
        std::vector<std::uint32_t> edges;
        Unrolling unrolling;
    };

    /// Breadth first from the root; at last groups, which others mostly pass over.
    std::vector<std::uint32_t> nodes_by_distance() const {
        std::vector<std::uint32_t> order = {model_.edges.front().child};
        std::vector<bool> met(model_.nodes.size());
        met[order.front()] = true;
        for (std::size_t i = 0; i < order.size(); ++i) {
            const TraceNode& node = model_.nodes[order[i]];
            for (std::uint32_t e = 0; e < node.edge_count + node.stop_edge_count; ++e) {
                const std::uint32_t child = model_.edges[node.first_edge + e].child;
                if (!met[child]) order.push_back(child);
                met[child] = true;
            }
        }
        std::stable_partition(order.begin() + 1, order.end(),
                              [&](std::uint32_t number) { return model_.nodes[number].cullable; });
        return order;
    }

    void unroll(TraceNode& node) {
        if (node.kind != TraceNode::Kind::parts) return;
        Parts parts;
        for (std::uint32_t i = 0; i < node.edge_count; ++i)
            parts.edges.push_back(node.first_edge + i);
        parts.unrolling.least_steps = node.unending ? 1 : 0; // or it is cut itself
        const auto leads_to_union = [&](std::uint32_t number) {
            return is_union(model_.nodes[model_.edges[number].child]);
        };
        // A union that is never cut where the parts passed over are not.
        const auto leads_to_group = [&](std::uint32_t number) {
            const TraceEdge& edge = model_.edges[number];
            const TraceNode& child = model_.nodes[edge.child];
            return is_union(child) && !child.cullable &&
                   (!child.unending || edge.levels < parts.unrolling.least_steps);
        };
        const auto has_groups = [&] { return std::ranges::any_of(parts.edges, leads_to_group); };
        std::vector<Unrolling> unrollings;
        bool deeper = has_groups();
        std::size_t edges = model_.edges.size();
        while (unrollings.size() < most_unrollings) {
            for (int i = 0; i < most_groups && expand(parts, leads_to_group); ++i) {
            }
            if (has_groups()) { // half of the way
                model_.edges.resize(edges);
                model_.looks.resize(edges);
                break;
            }
            for (const std::uint32_t edge : parts.edges)
                include_in_reach(node, model_.edges[edge]);
            add_leaves(parts);
            parts.unrolling.most_speck_size = most_speck_size(parts);
            if (deeper || parts.unrolling.leaf_tree != no_tree) {
                parts.unrolling.tree = deeper ? tree_over(parts.edges) : node.tree;
                unrollings.push_back(parts.unrolling);
            }
            edges = model_.edges.size();
            deeper = expand(parts, leads_to_union);
            if (!deeper) break;
        }
        node.first_unrolling = static_cast<std::uint32_t>(model_.unrollings.size());
        node.unrolling_count = static_cast<std::uint32_t>(unrollings.size());
        model_.unrollings.insert(model_.unrollings.end(), unrollings.rbegin(), unrollings.rend());
    }

    /// Adds the drawing of the parts where all that can be are cut.
    void add_leaves(Parts& parts) {
        parts.unrolling.leaf_tree = no_tree;
        parts.unrolling.most_size = -1;
        parts.unrolling.last_steps = Unrolling::no_steps;
        std::size_t count = 0;
        for (const std::uint32_t edge : parts.edges) {
            const std::size_t leaves = leaves_of(model_.edges[edge]);
            count += leaves;
            if (leaves == 0 || count > most_leaves) return;
        }
        if (leaves_in_all_ + count > most_leaves_in_all) return;
        std::vector<std::uint32_t> leaves;
        for (const std::uint32_t number : parts.edges) {
            const TraceEdge edge = model_.edges[number];
            const TraceNode& child = model_.nodes[edge.child];
            if (is_solid(child)) {
                leaves.push_back(number);
                continue;
            }
            if (child.edge_count > 0)
                parts.unrolling.most_size = std::max(parts.unrolling.most_size,
                                                     2 * child.ball_radius * edge.stretch / child.cut_detail);
            for (std::uint32_t i = 0; i < child.stop_edge_count; ++i)
                leaves.push_back(add_edge(number, (child.first_edge + child.edge_count + i) | from_cut));
        }
        leaves_in_all_ += count;
        parts.unrolling.leaf_tree = tree_over(leaves);
        parts.unrolling.last_steps = last_steps(parts);
    }

    double most_speck_size(const Parts& parts) const {
        double most = 0;
        for (const std::uint32_t number : parts.edges) {
            const TraceEdge& edge = model_.edges[number];
            const TraceNode& child = model_.nodes[edge.child];
            if (child.speck_count == 0 || !child.cullable || !edge.similarity)
                return std::numeric_limits<double>::infinity();
            most = std::max(most, 2 * child.ball_radius * edge.stretch / std::min(1.0, child.cut_detail));
        }
        return most;
    }

    /// Number of levels left in the node with which all of the parts have none.
    std::uint32_t last_steps(const Parts& parts) const {
        std::uint32_t steps = Unrolling::no_steps;
        for (const std::uint32_t number : parts.edges) {
            const TraceEdge& edge = model_.edges[number];
            const TraceNode& child = model_.nodes[edge.child];
            if (is_solid(child) || child.edge_count == 0) continue;
            if (!child.unending || (steps != Unrolling::no_steps && steps != edge.levels))
                return Unrolling::no_steps;
            steps = edge.levels;
        }
        return steps;
    }

    /// Primitives that are drawn of a part as it is, or cut; 0 if there is more to it. Those that are turned
    /// would be met some rounding away from where they are met one level after the other, which shows where
    /// surfaces coincide.
    std::size_t leaves_of(const TraceEdge& edge) const {
        const TraceNode& node = model_.nodes[edge.child];
        if (!edge.upright) return 0;
        if (is_solid(node)) return 1;
        if (node.kind != TraceNode::Kind::parts || node.faint || node.widens) return 0;
        if (!(node.edge_count > 0 ? node.cullable : node.unending)) return 0; // no edges: no steps are left
        for (std::uint32_t i = 0; i < node.stop_edge_count; ++i) {
            const TraceEdge& stop = model_.edges[node.first_edge + node.edge_count + i];
            if (!stop.upright || !is_solid(model_.nodes[stop.child])) return 0;
        }
        return node.stop_edge_count;
    }

    /// Puts their parts in place of those edges of which it holds; false if there are none, or too many.
    template<typename Holds> bool expand(Parts& parts, const Holds& holds) {
        std::size_t count = 0;
        bool any = false;
        for (const std::uint32_t number : parts.edges) {
            const bool expanded = holds(number);
            any = any || expanded;
            count += expanded ? model_.nodes[model_.edges[number].child].edge_count : 1;
        }
        if (!any || count > most_parts || model_.edges.size() - leaves_in_all_ + count > most_edges_ ||
            made_ + count > most_made)
            return false;
        made_ += count;
        Parts deeper{{}, parts.unrolling};
        for (const std::uint32_t number : parts.edges) {
            if (!holds(number)) {
                deeper.edges.push_back(number);
                continue;
            }
            const TraceNode& child = model_.nodes[model_.edges[number].child];
            pass_over(model_.edges[number], child, deeper.unrolling);
            for (std::uint32_t i = 0; i < child.edge_count; ++i)
                deeper.edges.push_back(add_edge(number, child.first_edge + i));
        }
        parts = std::move(deeper);
        return true;
    }

    static bool is_union(const TraceNode& node) {
        return node.kind == TraceNode::Kind::parts && node.edge_count > 0;
    }

    /// Notes what must hold for a node to be gone through.
    static void pass_over(const TraceEdge& edge, const TraceNode& child, Unrolling& unrolling) {
        if (child.unending) unrolling.least_steps = std::max(unrolling.least_steps, edge.levels + 1);
        if (child.cullable)
            unrolling.least_size =
                std::min(unrolling.least_size, 2 * child.ball_radius * edge.stretch *
                                                   (edge.similarity ? 1 : edge.flatness) / child.cut_detail);
        unrolling.flattest_edge =
            std::min(unrolling.flattest_edge, (edge.similarity ? 1 : edge.flatness) * child.flattest_edge);
    }

    void include_in_reach(TraceNode& node, const TraceEdge& edge) {
        const TraceNode& child = model_.nodes[edge.child];
        if (is_endless(child)) return;
        const Vec3 centre = edge.parent_from_child.affine()(vec3_of(child.ball_centre));
        node.reach = std::max(node.reach, glm::distance(centre, vec3_of(node.ball_centre)) +
                                              edge.stretch * child.ball_radius);
    }

    std::uint32_t add_edge(std::uint32_t before, std::uint32_t last) {
        const TraceEdge& first = model_.edges[before];
        const TraceEdge& second = model_.edges[last & ~from_cut];
        TraceEdge edge;
        edge.turns = second.turns;
        edge.child = second.child;
        edge.to_primitive = second.to_primitive;
        edge.levels = first.levels + second.levels;
        const Affine parent_from_middle = first.parent_from_child.affine();
        const Affine parent_from_child = parent_from_middle * second.parent_from_child.affine();
        edge.parent_from_child = LaneMap(parent_from_child);
        edge.child_from_parent =
            LaneMap(second.child_from_parent.affine() * first.child_from_parent.affine());
        edge.similarity = first.similarity && second.similarity;
        edge.flatness = first.flatness * second.flatness;
        edge.stretch = edge.similarity ? first.stretch * second.stretch : norm(parent_from_child.linear);
        edge.growth = 1 / edge.stretch;
        edge.find_upright();
        edge.box = box_of(first, second, parent_from_middle, parent_from_child);
        model_.looks.push_back(look_of(before, last));
        model_.edges.push_back(edge);
        return static_cast<std::uint32_t>(model_.edges.size() - 1);
    }

    TraceLook look_of(std::uint32_t before, std::uint32_t last) const {
        const TraceLook& first = model_.looks[before];
        const TraceLook& second = model_.looks[last & ~from_cut];
        TraceLook look = second;
        look.tint = first.tint * second.tint;
        if (!second.material) look.material = first.material;
        if (second.node == TraceLook::none) look.node = first.node;
        look.levels = first.levels + second.levels;
        look.before = before;
        look.last = last;
        look.length = static_cast<std::uint16_t>(first.length + second.length);
        look.as_one = first.as_one && second.as_one && !(last & from_cut && first.child_has_mean);
        return look;
    }

    Box box_of(const TraceEdge& first, const TraceEdge& second, const Affine& parent_from_middle,
               const Affine& parent_from_child) {
        if (second.box.empty()) return {};
        const TraceNode& child = model_.nodes[second.child];
        if (is_solid(child)) return box_about_image(child.primitive, parent_from_child);
        const Box box = both(transformed(parent_from_middle, second.box), first.box);
        if (!is_union(child) || keeps_axes(parent_from_child.linear) || looks_ > most_looks) return box;
        return both(box, box_of_parts(parent_from_child, child, most_looked_at));
    }

    /// Smaller than the box of a turned box, by the boxes of `most` smaller parts.
    Box box_of_parts(const Affine& place, const TraceNode& node, std::uint32_t most) {
        const std::uint32_t count = node.edge_count + node.stop_edge_count;
        looks_ += count;
        Box box;
        for (std::uint32_t i = 0; i < count; ++i) {
            if (cancel_.raised()) throw Cancelled();
            const TraceEdge& edge = model_.edges[node.first_edge + i];
            if (edge.box.empty()) continue;
            const TraceNode& child = model_.nodes[edge.child];
            const Affine place_of_child = place * edge.parent_from_child.affine();
            Box part = is_solid(child) ? box_about_image(child.primitive, place_of_child)
                                       : transformed(place, edge.box);
            const std::uint32_t most_below = (most - 1) / count;
            if (is_union(child) && most_below > 0)
                part = both(part, box_of_parts(place_of_child, child, most_below));
            box.include(part);
        }
        if (node.stop_tree == no_tree && (node.cullable || node.unending))
            box.include(box_of_image(PrimitiveKind::sphere, place * node.node_from_proxy.affine()));
        return box;
    }

    static bool is_solid(const TraceNode& node) {
        return node.kind == TraceNode::Kind::primitive && node.primitive != PrimitiveKind::plane;
    }

    /// The intersection of two boxes that meet.
    static Box both(const Box& a, const Box& b) {
        const Vec3 low = glm::max(a.min, b.min), high = glm::min(a.max, b.max);
        return {glm::min(low, high), glm::max(low, high)}; // rounding may turn what is flat inside out
    }

    std::uint32_t tree_over(const std::vector<std::uint32_t>& edges) {
        std::vector<BoxedItem> items = grouped_items(model_, edges);
        return build_box_tree(items, model_.boxes, cancel_);
    }

    TraceModel& model_;
    const CancelFlag& cancel_;
    const std::size_t most_edges_; ///< without leaves
    std::size_t leaves_in_all_ = 0, made_ = 0, looks_ = 0;
};

} // namespace

void add_unrollings(TraceModel& model, const CancelFlag& cancel) {
    Unroller(model, cancel).run();
}

} // namespace graftal
