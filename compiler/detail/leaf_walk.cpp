#include "compiler/detail/leaf_walk.h"

#include <algorithm>
#include <ranges>

#include "compiler/detail/graph/edge_cell.h"
#include "compiler/detail/graph/piece_kind.h"
#include "compiler/detail/piece.h"
#include "compiler/primitives/texture_space.h"

namespace graftal {

namespace {

/// Visits after which parts are compared: most walks are at their end by then.
constexpr std::uint64_t most_patience = 4096;
constexpr double cell_half_widths = 0.5;
/// Cost of a comparison, measured: it finds singular values, and a cell of a table.
constexpr std::uint64_t visits_of_a_comparison = 4;

} // namespace

LeafWalk::LeafWalk(const DetailGraph& cut, const Symmetry& symmetry, const BakeRequest& request,
                   std::span<const Painter> painters)
    : cut_(cut), symmetry_(symmetry), detail_per_unit_(request.detail_per_unit), error_px_(request.error_px),
      self_shadows_(request.self_shadows),
      limit_normals_(request.limit_normals), visit_{request.representative, request.steps, {}, 1, 0},
      cells_from_unit_(request.half_widths_from_unit / cell_half_widths) {
    for (const Painter& painter : painters)
        paints_.push_back({{{}, painter.inherited, request.material}, painter.pair});
    stack_.push_back(visit_);
    paint_stack_ = paints_;
}

bool LeafWalk::next(WalkedLeaf& leaf) {
    while (!stack_.empty()) {
        pop();
        const DetailNode& shape = cut_.nodes[visit_.shape];
        leaf.material = paints_.front().material;
        leaf.culled_detail = visit_.culled_detail;
        leaf.crushed = visit_.crushed;
        leaf.faint = visit_.faint || (!shape.primitive && shape.shadowless);
        leaf.colours.clear();
        leaf.normals = {};
        leaf.proxy = !shape.primitive;
        leaf.tint = paints_.front().tint;
        leaf.turns = visit_.turns;
        leaf.light_share = visit_.light_share;
        if (shape.primitive) {
            leaf.primitive = *shape.primitive;
            leaf.representative_from_leaf = visit_.representative_from_node;
            for (const Painted& paint : paints_)
                leaf.colours.push_back(paint.tint.over(paint.inherited));
            return true;
        }
        const double detail = 2 * shape.ball.radius * visit_.scale * detail_per_unit_;
        const bool cut = is_cut(shape, visit_.steps, detail, error_px_);
        if (followed_edges(shape, cut).empty() && (cut || !shape.cell)) {
            if (shape.finish) leaf.material = shape.finish;
            leaf.primitive = PrimitiveKind::sphere;
            leaf.representative_from_leaf = visit_.representative_from_node * shape.node_from_proxy;
            for (const Painted& paint : paints_)
                leaf.colours.push_back(
                    paint.tint.over(colour_of_proxy(colours_of(paint)).over(paint.inherited)));
            leaf.culled_detail = detail <= 1 ? detail : 0;
            leaf.normals = normals();
            leaf.light_share = light_share(detail);
            return true;
        }
        enter_ball(shape);
        push_children(cut, detail);
    }
    return false;
}

void LeafWalk::pop() {
    ++visits_;
    visit_ = stack_.back();
    stack_.pop_back();
    const auto begin = paint_stack_.end() - static_cast<std::ptrdiff_t>(paints_.size());
    std::copy(begin, paint_stack_.end(), paints_.begin());
    paint_stack_.erase(begin, paint_stack_.end());
}

void LeafWalk::enter_ball(const DetailNode& shape) {
    if (!limit_normals_ || !shape.unending) return;
    balls_.resize(visit_.depth++);
    balls_.push_back({visit_.representative_from_node(shape.ball.centre), visit_.scale * shape.ball.radius});
}

NormalField LeafWalk::normals() const {
    NormalField field;
    if (visit_.crushed) return field;
    for (std::uint32_t level = 1; level <= limit_normal_levels && level <= visit_.depth; ++level) {
        const Ball& ball = balls_[visit_.depth - level];
        field.add(static_cast<int>(level), ball.centre, ball.radius);
    }
    return field;
}

/// Share of light of the stand-in for the node that is visited.
double LeafWalk::light_share(double detail) const {
    if (!self_shadows_) return visit_.light_share;
    return self_shadows_->share_within(visit_.light_share, visit_.shape, detail, error_px_);
}

void LeafWalk::push_children(bool is_cut, double detail) {
    if (cut_.nodes[visit_.shape].cell && !is_cut) return push_items();
    const auto& edges = followed_edges(cut_.nodes[visit_.shape], is_cut);
    for (std::size_t i = edges.size(); i-- > 0;) {
        fill_child(edges[i], is_cut, detail, stack_.emplace_back());
        if (!is_new(stack_.back())) {
            stack_.pop_back();
            continue;
        }
        for (const Painted& paint : paints_)
            fill_child(paint, i, is_cut, paint_stack_.emplace_back());
    }
}

/// The last of them first. All painters show them alike.
void LeafWalk::push_items() {
    std::vector<DetailEdge> edges;
    for_each_edge(cut_.nodes[visit_.shape], false, [&](const DetailEdge& edge) { edges.push_back(edge); });
    for (const DetailEdge& edge : edges | std::views::reverse) {
        fill_child(edge, false, 0, stack_.emplace_back());
        for (const Painted& paint : paints_) {
            Painted& child = paint_stack_.emplace_back(paint);
            child.pair = symmetry_.pair[edge.child];
            child.descend(look_step(cut_, cut_.nodes[visit_.shape], false, edge));
        }
    }
}

/// False for a part that lies as another did, as nearly as can be seen.
bool LeafWalk::is_new(const Visit& child) {
    if (visits_ < most_patience || cells_from_unit_ == Mat3(0.0) || !cut_.nodes[child.shape].widens)
        return true;
    visits_ += visits_of_a_comparison;
    const double size = std::max(cut_.nodes[child.shape].ball.radius, 1e-280);
    const Vec3 centre = child.representative_from_node(cut_.nodes[child.shape].ball.centre);
    const Affine cells{size * (cells_from_unit_ * child.representative_from_node.linear),
                       cells_from_unit_ * centre};
    return met_.insert(alike_kind(child.shape, child.steps, child.faint), cells, child.scale);
}

void LeafWalk::fill_child(const DetailEdge& edge, bool is_cut, double detail, Visit& child) const {
    child.shape = edge.child;
    child.steps = steps_below(visit_.steps, edge);
    child.representative_from_node = visit_.representative_from_node * edge.node_from_child;
    child.scale = size_below(visit_.scale, edge, child.representative_from_node.linear);
    child.depth = visit_.depth;
    if (cut_.nodes[edge.child].primitive) child.turns = length_in_turns(edge.node_from_child.linear);
    child.culled_detail = is_cut && detail <= 1 ? detail : visit_.culled_detail;
    child.light_share = is_cut ? light_share(detail) : visit_.light_share;
    child.crushed = visit_.crushed || cut_.nodes[visit_.shape].sealed;
    child.faint = visit_.faint || (is_cut && detail <= 1 && cut_.nodes[visit_.shape].shadowless);
}

void LeafWalk::fill_child(const Painted& paint, std::size_t edge, bool is_cut, Painted& child) const {
    const NodePair& pair = symmetry_.pairs[paint.pair];
    const DetailNode& colours = cut_.nodes[pair.b];
    const DetailEdge& twin = followed_edges(colours, is_cut)[(is_cut ? pair.stop_edge : pair.edge)[edge]];
    child = paint;
    child.pair = (is_cut ? pair.stop_pair : pair.edge_pair)[edge];
    child.descend(look_step(cut_, colours, is_cut, twin));
}

} // namespace graftal
