#include "compiler/povray/cut/placed_runs.h"

#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "compiler/support/id_table.h"

namespace graftal {

namespace {

bool shows_alike(const Piece& a, const Piece& b) {
    return a.world_from_node == b.world_from_node && a.tint == b.tint && a.inherited == b.inherited &&
           a.material == b.material;
}

/// Tells where parts lie, to 1e-9 of the model's size, in one number.
class Digests {
  public:
    explicit Digests(double size) : unit_(1e-9 * std::max(size, 1e-280)) {}

    std::uint64_t of(const Piece& piece, const RunItem& item, RunShape shape, bool ball) const {
        const Affine& world = piece.world_from_node;
        std::uint64_t hash = mixed(0x243F6A8885A308D3ull, std::uint64_t{shape.index()});
        const bool round = shape.is_sphere();
        add(world(ball ? item.base + item.axis : item.base), hash);
        if (!round) add(world.linear * item.axis, hash);
        // Two radii at right angles, and a third aside, tell how a map stretches what is round.
        for (const Vec3& side : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)})
            add(world.linear * (item.radius * side), hash);
        return hash;
    }

  private:
    void add(const Vec3& v, std::uint64_t& hash) const {
        for (int i = 0; i < 3; ++i)
            hash = mixed(hash, static_cast<std::uint64_t>(static_cast<std::int64_t>(
                                   std::clamp(std::round(v[i] / unit_), -9e18, 9e18))));
    }

    double unit_;
};

} // namespace

bool PlacedRuns::can_hold(const DetailGraph& cut, const Piece& piece) {
    const DetailNode& node = cut.nodes[piece.node];
    if (!node.cell || node.textured || node.widens || piece.faint) return false;
    if (piece.material && cut.materials[*piece.material].is_painted()) return false;
    const Vec3 sigma = singular_values(piece.world_from_node.linear);
    return sigma.z * node.cell->flattest > flattest_placement * sigma.x;
}

void PlacedRuns::add(const Piece& piece, const EdgeCell& cell) {
    parts_ += cell.size();
    if (!ranges_.empty()) {
        Range& last = ranges_.back();
        if (last.source == cell.source && last.first + last.count == cell.first &&
            shows_alike(last.piece, piece)) {
            last.count += cell.count;
            return;
        }
    }
    ranges_.push_back({cell.source, cell.first, cell.count, piece, nullptr});
}

double PlacedRuns::sift(const DetailGraph& cut, const Projection& projection) {
    const Digests digests(cut.nodes[cut.root].ball.radius);
    const auto for_each = [&](Range& range, const auto& visit) {
        for (std::size_t i = 0; i < range.count; ++i) {
            const RunItem& item = (*range.source->run)[range.first + i];
            visit(2 * i, item, item.shape, false);
            if (item.ball) visit(2 * i + 1, item, RunShape(PrimitiveKind::sphere), true);
        }
    };
    std::vector<std::uint64_t> all;
    all.reserve(parts_);
    for (Range& range : ranges_)
        for_each(range, [&](std::size_t, const RunItem& item, RunShape shape, bool ball) {
            all.push_back(digests.of(range.piece, item, shape, ball));
        });
    std::ranges::sort(all);
    std::unordered_set<std::uint64_t> repeated, met;
    for (std::size_t i = 1; i < all.size(); ++i)
        if (all[i] == all[i - 1]) repeated.insert(all[i]);
    std::vector<std::uint64_t>().swap(all);

    double finest = std::numeric_limits<double>::infinity();
    if (repeated.empty() && !projection.culls() && !projection.drops_any()) return finest;
    for (Range& range : ranges_) {
        auto left_out = std::make_shared<std::vector<bool>>(2 * range.count);
        bool any = false;
        for_each(range, [&](std::size_t part, const RunItem& item, RunShape shape, bool ball) {
            const DetailEdge edge =
                ball ? edge_to_ball(*range.source, item) : edge_to_body(*range.source, item);
            const Ball& unit_ball = cut.nodes[edge.child].ball;
            const Ball about{range.piece.world_from_node(edge.node_from_child(unit_ball.centre)),
                             range.piece.scale * edge.stretch * unit_ball.radius};
            bool out = projection.drops(about);
            if (!out && !repeated.empty()) {
                const std::uint64_t digest = digests.of(range.piece, item, shape, ball);
                out = repeated.contains(digest) && !met.insert(digest).second;
            }
            if (out)
                (*left_out)[part] = any = true;
            else if (projection.culls() && projection.sees(about))
                finest = std::min(finest, 1 / projection.detail_per_unit(about));
        });
        if (any) range.left_out = std::move(left_out);
    }
    return finest;
}

} // namespace graftal
