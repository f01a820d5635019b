#include "compiler/povray/cut/place_pieces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include <glm/matrix.hpp>

#include "compiler/detail/bake.h"
#include "compiler/detail/graph/alike_set.h"
#include "compiler/detail/graph/edge_cell.h"
#include "compiler/detail/least_width.h"
#include "compiler/detail/placed_set.h"
#include "compiler/detail/work.h"
#include "compiler/graph/walk.h"
#include "compiler/povray/costs.h"
#include "compiler/primitives/tessellate.h"
#include "compiler/primitives/texture_space.h"
#include "compiler/support/stretch.h"

namespace graftal {

namespace {

using PainterKey = std::tuple<std::uint32_t, std::uint32_t, std::array<double, 3>>;
/// Meshes with pictures have one painter each, others any number.
using RequestKey = std::tuple<NodeId, std::uint32_t, std::int32_t, std::int64_t, std::optional<PainterKey>>;

/// Places whose maps differ by no more than this factor in any direction share a mesh whose parts are drawn
/// wider than they are. Widths are right to within this factor.
constexpr double most_width_ratio = 1.3;

bool nearly_as_wide(const Mat3& a, const Mat3& b) {
    const Mat3 a_from_b = a * glm::inverse(b);
    constexpr double most_volume = most_width_ratio * most_width_ratio * most_width_ratio;
    const double volume = std::abs(glm::determinant(a_from_b));
    if (!(volume <= most_volume && volume >= 1 / most_volume)) return false; // most differ by far
    const Vec3 sigma = singular_values(a_from_b);
    return sigma.x <= most_width_ratio && sigma.z >= 1 / most_width_ratio;
}

/// A piece, and the operand that it is a part of.
struct OperandPiece : Piece {
    std::uint32_t operand = no_operand;

    bool is_of_solid() const { return operand != no_operand; }
};

/// Depth-first unfolding down to the pieces that become meshes.
class Placing {
  public:
    Placing(const DetailGraph& cut, const Symmetry& symmetry, const Projection& projection,
            const Choice& choice, Weights& weights, const SelfShadows* self_shadows, WorkMeter* meter)
        : cut_(cut), symmetry_(symmetry), projection_(projection), choice_(choice), weights_(weights),
          self_shadows_(self_shadows), walk_({.meter = meter}), seen_(cut.nodes[cut.root].ball.radius),
          holds_combined_(std::ranges::any_of(cut.nodes, &DetailNode::is_combined)) {}

    bool run(const Piece& root, AssemblyLimits& limits) {
        const double most_placements = limits.memory_bytes / PovrayCosts::least_placement;
        walk_.push({root});
        for (OperandPiece piece; walk_.next(piece);) {
            limits.work_seconds -= (1 + more_work_) / WorkRates::leaves;
            more_work_ = 0;
            const std::size_t before = out_.runs.part_count();
            if (static_cast<double>(out_.things.size() + before) > most_placements || limits.work_seconds < 0)
                return false;
            visit(piece);
            limits.work_seconds -= static_cast<double>(out_.runs.part_count() - before) / WorkRates::leaves;
        }
        return true;
    }

    PlacedPieces take() && { return std::move(out_); }

  private:
    /// Work in leaves: to compare a piece with others, to widen it, and to place it, which waits for memory.
    static constexpr double work_of_comparison = 2, work_of_widening = 3, work_of_placing = 2;

    void visit(const OperandPiece& piece) {
        const DetailNode& node = cut_.nodes[piece.node];
        // An operand takes part wherever it lies, and what encloses no volume takes none.
        if (piece.is_of_solid() && is_singular(piece.world_from_node)) return;
        if (!piece.is_of_solid() && !node.unbounded && projection_.drops(world_ball(cut_, piece))) return;
        if (node.primitive && !node.unbounded && piece.material && is_painted(*piece.material))
            return place_textured(*node.primitive, piece);
        if (node.primitive)
            return place_primitive(*node.primitive, piece.world_from_node, piece, piece.inherited);
        const double detail = detail_of(cut_, projection_, piece);
        const bool cut = is_cut(node, piece.steps, detail, projection_.error_px());
        const PieceKind kind = weights_.normalised(kind_of(cut_, projection_, piece));
        if (cut && detail <= 1) out_.culled_detail = std::max(out_.culled_detail, detail);
        const bool hair = is_hair(piece);
        const bool bakes = !hair && !choice_.spelt_out;
        if (node.sealed && bakes && place_mesh(piece, kind)) return;
        if (edge_count(node, cut) == 0 && node.unbounded) return; // of a plane that became a line
        if (edge_count(node, cut) == 0) return place_proxy(node, piece, light_share(piece, detail));
        const Weights::Weight weight = weights_.of(kind);
        if (!holds_combined_ && !node.unbounded && !piece.faint && !hair && weight.leaves > 1 &&
            (weight.triangles <= choice_.threshold || weights_.is_shell(kind)) && place_mesh(piece, kind))
            return;
        if (!cut && !piece.is_of_solid() && PlacedRuns::can_hold(cut_, piece))
            return out_.runs.add(piece, *node.cell);
        const bool combined = node.is_combined() && !(cut && node.terminal);
        std::uint32_t operand = combined ? add_operands(node, cut, piece.operand) : piece.operand;
        bool placeable = true;
        for_each_edge(node, cut, [&](const DetailEdge& edge) {
            OperandPiece child{descend(cut_, piece, edge, cut), operand};
            child.faint = piece.faint || (cut && detail <= 1 && node.shadowless);
            if (cut) child.light_share = light_share(piece, detail);
            placeable = placeable && (edge.similarity || is_placeable(child));
            walk_.push(child);
            if (combined) ++operand;
        });
        if (!placeable && !node.unbounded && bakes && place_mesh(piece, kind)) return walk_.drop_children();
        if (!hair && !spells_out_specks_) return;
        more_work_ += work_of_comparison * static_cast<double>(walk_.children());
        walk_.drop_children_if([&](const OperandPiece& child) { return !is_new(child); });
    }

    /// The number of the first of them.
    std::uint32_t add_operands(const DetailNode& node, bool cut, std::uint32_t holder) {
        const auto count = static_cast<std::uint32_t>(edge_count(node, cut));
        out_.combined.push_back({node.combination, holder, operands_, count});
        operands_ += count;
        return operands_ - count;
    }

    /// Share of light of the stand-in for the piece, if it is cut.
    double light_share(const OperandPiece& piece, double detail) const {
        if (!self_shadows_) return piece.light_share;
        return self_shadows_->share_within(piece.light_share, piece.node, detail, projection_.error_px());
    }

    /// Whether the piece is drawn wider than it is, and so much flatter than its node that few would share
    /// its mesh. It is spelt out.
    bool is_hair(const OperandPiece& piece) const {
        constexpr double flattest_shape = 1e-2;
        return cut_.nodes[piece.node].widens && projection_.culls() && !choice_.spelt_out &&
               is_singular(piece.world_from_node, flattest_shape);
    }

    /// Whether POV-Ray can place it, or what it becomes.
    bool is_placeable(const OperandPiece& piece) const {
        const bool widens = piece.faint || cut_.nodes[piece.node].widens;
        return (widens && projection_.culls()) || !is_singular(piece.world_from_node, flattest_placement);
    }

    /// Where parts of sets without area pile up, one of those that lie alike to a quarter of a pixel stands
    /// for all.
    bool is_new(const OperandPiece& piece) {
        if (!cut_.nodes[piece.node].widens) return true;
        const Ball ball = world_ball(cut_, piece);
        const double cell = 0.5 * projection_.least_half_width(ball);
        const double size = std::max(cut_.nodes[piece.node].ball.radius, 1e-280);
        const Affine cells{(size / cell) * piece.world_from_node.linear, ball.centre / cell};
        return specks_.insert(alike_kind(piece.node, piece.steps, piece.faint), cells, piece.scale);
    }

    void keep(const Placed& thing) {
        out_.things.push_back(thing);
        more_work_ += work_of_placing;
    }

    void place_proxy(const DetailNode& node, const OperandPiece& piece, double light_share) {
        OperandPiece proxy = piece;
        proxy.light_share = light_share;
        if (node.finish) proxy.material = node.finish;
        proxy.faint = piece.faint || node.shadowless;
        place_primitive(PrimitiveKind::sphere, piece.world_from_node * node.node_from_proxy, proxy,
                        colour_of_proxy(node).over(piece.inherited));
    }

    void place_primitive(const Primitive& primitive, const Affine& world_from_primitive,
                         const OperandPiece& piece, Rgb base) {
        Placed thing;
        thing.primitive = out_.primitives.of(primitive);
        thing.operand = piece.operand;
        const Ball ball = world_ball(cut_, piece);
        if (piece.is_of_solid()) {
            thing.world_from_thing = world_from_primitive;
        } else if (primitive == PrimitiveKind::plane && is_singular(world_from_primitive, flattest_plane)) {
            const std::optional<Affine> place = place_of_plane(world_from_primitive);
            if (!place) return;
            thing.world_from_thing = *place;
        } else {
            thing.world_from_thing = drawn(primitive, world_from_primitive, piece);
        }
        if (thing.world_from_thing != world_from_primitive) more_work_ += work_of_widening;
        const double half_width = projection_.least_half_width(ball);
        const bool speck = !piece.is_of_solid() && piece.faint && !choice_.spelt_out &&
                           largest_stretch(world_from_primitive.linear) <= half_width;
        const Affine mark = speck ? speck_mark(thing.world_from_thing, half_width) : thing.world_from_thing;
        if (!piece.is_of_solid() && !seen_.insert(2 * thing.primitive, mark)) return;
        note_finest(ball);
        thing.rgb = piece.tint.over(base);
        thing.material = piece.material;
        thing.light_share = piece.light_share;
        keep(thing);
    }

    Affine drawn(const Primitive& primitive, const Affine& world_from_primitive,
                 const OperandPiece& piece) const {
        if (primitive == PrimitiveKind::plane) return world_from_primitive;
        return drawn_leaf(primitive, world_from_primitive, piece.faint,
                          projection_.least_half_width(world_ball(cut_, piece)))
            .place;
    }

    void place_textured(const Primitive& primitive, const OperandPiece& piece) {
        const Ball ball = world_ball(cut_, piece);
        Placed thing;
        thing.operand = piece.operand;
        thing.world_from_thing =
            piece.is_of_solid() ? piece.world_from_node : drawn(primitive, piece.world_from_node, piece);
        const double px = norm(thing.world_from_thing.linear) * projection_.pixels_that_matter(ball);
        const TextureSpace space =
            texture_space(primitive, cut_.materials[*piece.material].around, piece.turns);
        const TexturedPrimitive shape{
            primitive, fineness_for(primitive, tessellation_tolerance_px / std::max(px, 1e-300)),
            space.around, space.along};
        const auto [place, added] =
            textured_of_.emplace(shape, static_cast<std::uint32_t>(out_.textured.size()));
        if (added) out_.textured.push_back(shape);
        if (!piece.is_of_solid() && !seen_.insert(2 * out_.primitives.of(primitive), thing.world_from_thing))
            return;
        note_finest(ball);
        thing.textured = place->second;
        thing.painted = primitive;
        thing.tint = piece.tint;
        thing.material = piece.material;
        thing.light_share = piece.light_share;
        keep(thing);
    }

    /// The mesh that serves the piece, and whether it is a new one. As for parts that are drawn wider than
    /// they are, one that lies alike; nothing where there are too many that do not, and a mesh would not be
    /// shared.
    std::optional<std::pair<std::uint32_t, bool>> request_for(const RequestKey& key,
                                                              const OperandPiece& piece, bool shell) {
        std::vector<std::uint32_t>& alike = request_of_[key];
        Mat3 shape(0.0);
        if (cut_.nodes[piece.node].widens && projection_.culls() && !shell) {
            const Affine place = piece.world_from_node * symmetry_.node_from_representative[piece.node];
            const Mat3 linear = is_singular(place, flattest_leaf) ? Mat3(piece.scale) : place.linear;
            shape = linear / projection_.least_half_width(world_ball(cut_, piece));
        }
        more_work_ += work_of_comparison * static_cast<double>(alike.size());
        for (const std::uint32_t request : alike)
            if (shape == Mat3(0.0) || nearly_as_wide(shape, out_.requests[request].half_widths_from_unit))
                return std::pair(request, false);
        constexpr std::size_t most_shapes = 8;
        if (alike.size() == most_shapes) return std::nullopt;
        alike.push_back(static_cast<std::uint32_t>(out_.requests.size()));
        out_.requests.emplace_back();
        out_.requests.back().half_widths_from_unit = shape;
        return std::pair(alike.back(), true);
    }

    /// False where the piece is to be spelt out.
    bool place_mesh(const OperandPiece& piece, const PieceKind& kind) {
        const bool shell = weights_.of(kind).crowded;
        const NodeId representative = shell ? piece.node : symmetry_.representative[piece.node];
        const std::int64_t finish = piece.material ? static_cast<std::int64_t>(*piece.material) : -1;
        const RequestKey key{representative, kind.steps, weights_.mesh_bin(kind), finish, own_painter(piece)};
        const auto found = request_for(key, piece, shell);
        if (!found) {
            spells_out_specks_ = true;
            return false;
        }
        const auto [request, added] = *found;
        if (added) {
            out_.requests[request].representative = representative;
            out_.requests[request].steps = kind.steps;
            out_.requests[request].material = piece.material;
            out_.requests[request].error_px = projection_.error_px();
            out_.requests[request].expected_leaves = weights_.of(kind).leaves;
            out_.requests[request].shell = shell;
        }
        BakeRequest& bake = out_.requests[request];
        const Ball ball = world_ball(cut_, piece);
        bake.detail_per_unit =
            std::max(bake.detail_per_unit, projection_.detail_per_unit(ball) * piece.scale);
        if (shell) {
            // The eye may lie within its ball, where a unit looks as large as can be.
            const double here = projection_.detail_per_unit({ball.centre, 0}) * piece.scale;
            out_.seen_detail.resize(out_.requests.size());
            out_.seen_detail[request] = std::max(out_.seen_detail[request], here);
        }
        bake.pixels_per_unit =
            std::max(bake.pixels_per_unit, projection_.pixels_that_matter(ball) * piece.scale);

        Placed thing;
        thing.request = request;
        thing.world_from_thing = piece.world_from_node;
        if (!shell)
            thing.world_from_thing = thing.world_from_thing * symmetry_.node_from_representative[piece.node];
        if (!seen_.insert(2 * thing.request + 1, thing.world_from_thing)) return true;
        note_finest(ball);
        thing.painter = painter(request, shell ? 0 : symmetry_.pair[piece.node], piece.inherited);
        thing.tint = piece.tint;
        thing.material = piece.material;
        thing.light_share = piece.light_share;
        keep(thing);
        return true;
    }

    bool is_painted(MaterialId material) const { return cut_.materials[material].is_painted(); }

    void note_finest(const Ball& ball) {
        if (projection_.culls() && projection_.sees(ball))
            out_.finest = std::min(out_.finest, 1 / projection_.detail_per_unit(ball));
    }

    std::optional<PainterKey> own_painter(const OperandPiece& piece) const {
        if (!cut_.nodes[piece.node].textured && !(piece.material && is_painted(*piece.material)))
            return std::nullopt;
        return PainterKey{0, symmetry_.pair[piece.node], as_array(piece.inherited)};
    }

    std::uint32_t painter(std::uint32_t request, std::uint32_t pair, const Rgb& inherited) {
        std::vector<Painter>& painters = out_.requests[request].painters;
        const auto [place, added] = painter_of_.emplace(PainterKey{request, pair, as_array(inherited)},
                                                        static_cast<std::uint32_t>(painters.size()));
        if (added) painters.push_back({pair, inherited});
        return place->second;
    }

    const DetailGraph& cut_;
    const Symmetry& symmetry_;
    const Projection& projection_;
    const Choice& choice_;
    Weights& weights_;
    const SelfShadows* self_shadows_;
    PlacedPieces out_;
    Walk<OperandPiece> walk_;
    std::map<TexturedPrimitive, std::uint32_t> textured_of_;
    PlacedSet seen_;
    AlikeSet specks_; ///< parts of sets without area
    bool spells_out_specks_ = false;
    const bool holds_combined_;
    std::uint32_t operands_ = 0; ///< so far
    double more_work_ = 0;       ///< in leaves, for the piece under way
    std::map<RequestKey, std::vector<std::uint32_t>> request_of_;
    std::map<PainterKey, std::uint32_t> painter_of_;
};

} // namespace

std::optional<PlacedPieces> place_pieces(const DetailGraph& cut, const Symmetry& symmetry,
                                         const Projection& projection, const Piece& root,
                                         const Choice& choice, Weights& weights, AssemblyLimits& limits,
                                         const SelfShadows* self_shadows) {
    Placing placing(cut, symmetry, projection, choice, weights, self_shadows, limits.meter);
    if (!placing.run(root, limits)) return std::nullopt;
    return std::move(placing).take();
}

} // namespace graftal
