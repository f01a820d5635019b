#include "compiler/cut/leaf_walk.h"

#include <algorithm>

namespace graftal {

LeafWalk::LeafWalk(const CutGraph& cut, const Symmetry& symmetry, const BakeRequest& request,
                   const Painter& painter)
    : cut_(cut), symmetry_(symmetry), detail_per_unit_(request.detail_per_unit) {
    stack_.push_back({painter.pair, request.steps, {}, 1, {}, painter.inherited, request.material, 0});
}

bool LeafWalk::next(WalkedLeaf& leaf) {
    while (!stack_.empty()) {
        const Visit visit = stack_.back();
        stack_.pop_back();
        const NodePair& pair = symmetry_.pairs[visit.pair];
        const CutNode& shape = cut_.nodes[pair.a];
        const CutNode& colours = cut_.nodes[pair.b];
        leaf.material = visit.material;
        leaf.culled_detail = visit.culled_detail;
        if (shape.primitive) {
            leaf.kind = *shape.primitive;
            leaf.representative_from_leaf = visit.representative_from_node;
            leaf.scale = visit.scale;
            leaf.rgb = visit.tint.over(visit.inherited);
            return true;
        }
        const double detail = 2 * shape.ball.radius * visit.scale * detail_per_unit_;
        const bool cut = is_cut(shape, visit.steps, detail);
        if (followed_edges(shape, cut).empty()) {
            leaf.kind = PrimitiveKind::sphere;
            leaf.representative_from_leaf = visit.representative_from_node * shape.node_from_proxy;
            leaf.scale = norm(leaf.representative_from_leaf.linear);
            leaf.rgb = visit.tint.over(colours.mean.over(visit.inherited));
            leaf.culled_detail = detail <= 1 ? detail : 0;
            return true;
        }
        push_children(visit, cut, detail);
    }
    return false;
}

void LeafWalk::push_children(const Visit& visit, bool is_cut, double detail) {
    const NodePair& pair = symmetry_.pairs[visit.pair];
    const CutNode& shape = cut_.nodes[pair.a];
    const CutNode& colours = cut_.nodes[pair.b];
    const auto& edges = followed_edges(shape, is_cut);
    const auto& twins = followed_edges(colours, is_cut);
    const auto& twin_of = is_cut ? pair.stop_edge : pair.edge;
    const auto& pair_of = is_cut ? pair.stop_pair : pair.edge_pair;
    for (std::size_t i = edges.size(); i-- > 0;) {
        const CutEdge& edge = edges[i];
        const CutEdge& twin = twins[twin_of[i]];
        Visit child;
        child.pair = pair_of[i];
        child.steps = steps_after(visit.steps, edge);
        child.representative_from_node = visit.representative_from_node * edge.node_from_child;
        child.scale =
            edge.similarity ? visit.scale * edge.stretch : norm(child.representative_from_node.linear);
        child.tint = visit.tint * twin.tint;
        child.inherited = is_cut && colours.terminal ? colours.mean.over(visit.inherited) : visit.inherited;
        child.material = visit.material;
        if (twin.material) {
            child.material = twin.material;
            child.inherited = cut_.materials[*twin.material].rgb;
        }
        child.culled_detail = is_cut && detail <= 1 ? detail : visit.culled_detail;
        stack_.push_back(child);
    }
}

} // namespace graftal
