#include "compiler/detail/piece.h"

#include <limits>

#include "compiler/detail/graph/edge_cell.h"
#include "compiler/graph/walk.h"
#include "compiler/primitives/texture_space.h"

namespace graftal {

Piece descend(const DetailGraph& cut, const Piece& piece, const DetailEdge& edge, bool piece_is_cut) {
    Piece child = piece;
    child.descend(look_step(cut, cut.nodes[piece.node], piece_is_cut, edge));
    child.node = edge.child;
    child.steps = steps_below(piece.steps, edge);
    child.world_from_node = piece.world_from_node * edge.node_from_child;
    child.scale = size_below(piece.scale, edge, child.world_from_node.linear);
    child.turns = cut.nodes[edge.child].primitive ? length_in_turns(edge.node_from_child.linear) : 1;
    return child;
}

Ball world_ball(const DetailGraph& cut, const Piece& piece) {
    const Ball& ball = cut.nodes[piece.node].ball;
    return {piece.world_from_node(ball.centre), piece.scale * ball.radius};
}

double detail_of(const DetailGraph& cut, const Projection& projection, const Piece& piece) {
    const Ball ball = world_ball(cut, piece);
    if (!projection.culls() || cut.nodes[piece.node].unbounded)
        return std::numeric_limits<double>::infinity();
    return 2 * ball.radius * projection.detail_per_unit(ball);
}

PieceKind kind_of(const DetailGraph& cut, const Projection& projection, const Piece& piece) {
    PieceKind kind{piece.node, piece.steps, PieceKind::endless_detail};
    if (projection.culls() && !cut.nodes[piece.node].unbounded)
        kind.unit_step = PieceKind::step_of(piece.scale * projection.detail_per_unit(world_ball(cut, piece)));
    return kind;
}

Weights::Weight weight_of(const DetailGraph& cut, const Projection& projection, Weights& weights,
                          const Piece& piece) {
    Weights::Weight sum;
    Walk<Piece> walk;
    walk.push(piece);
    constexpr std::uint64_t most_parts = 10'000;
    for (Piece part; walk.next(part);) {
        const PieceKind kind = weights.normalised(kind_of(cut, projection, part));
        const DetailNode& node = cut.nodes[part.node];
        if (!node.unbounded || node.primitive || walk.visits() > most_parts) {
            sum += weights.of(kind);
            continue;
        }
        const bool ends = weights.is_cut(kind);
        for_each_edge(node, ends, [&](const DetailEdge& edge) { walk.push(descend(cut, part, edge, ends)); });
    }
    return sum;
}

} // namespace graftal
