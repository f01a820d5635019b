#include "compiler/povray/cut/choose.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <queue>
#include <set>
#include <utility>

#include <glm/geometric.hpp>

#include "compiler/detail/graph/edge_cell.h"
#include "compiler/povray/costs.h"
#include "compiler/primitives/texture_space.h"
#include "compiler/support/stretch.h"

namespace graftal {

namespace {

/// Beyond this many, pieces are only counted.
constexpr double max_real_pieces = 300'000;
constexpr std::size_t max_splits = 200'000;
/// Each tree of a wood stands at a distance of its own. Where one node has more edges than this, details are
/// told apart only by this part of an octave. Else each tree would be a kind to be split by itself.
constexpr std::size_t many_edges = 4096;
constexpr int coarse_steps_an_octave = 16;

/// The pieces that one mesh would serve.
struct MeshKind {
    NodeId representative;
    std::uint32_t steps;
    std::int32_t bin;
    auto operator<=>(const MeshKind&) const = default;
};

class Chooser {
  public:
    Chooser(const DetailGraph& cut, const Symmetry& symmetry, const Projection& projection, Weights& weights,
            double most_bytes, WorkMeter* meter)
        : cut_(cut), symmetry_(symmetry), projection_(projection), weights_(weights), most_bytes_(most_bytes),
          placement_bytes_(PovrayCosts::placement +
                           (cut.tinted ? PovrayCosts::own_texture + PovrayCosts::own_layer : 0)),
          placement_text_(SdlLengths::placement + (cut.tinted ? SdlLengths::own_texture : 0)), meter_(meter) {
        const bool crowded = std::ranges::any_of(
            cut.nodes, [](const DetailNode& node) { return node.edges.size() > many_edges; });
        if (crowded) grain_ = PieceKind::steps_an_octave / coarse_steps_an_octave;
    }

    Choice choose(const Piece& root) {
        add_piece(root);
        Choice best = current(std::numeric_limits<double>::infinity());
        std::size_t splits = 0;
        while (!queue_.empty() && splits < max_splits) {
            const double weight = queue_.top().weight;
            for (; !queue_.empty() && queue_.top().weight == weight && splits < max_splits; ++splits) {
                const PieceKind kind = queue_.top().kind;
                queue_.pop();
                split(kind);
            }
            const double next = queue_.empty() ? 0 : queue_.top().weight;
            const Choice now = current(next);
            if (is_better(now, best)) best = now;
            if (!may_get_better(best)) break;
        }
        best.leaves = weight_of(cut_, projection_, weights_, root).leaves;
        best.pieces = pieces_;
        return best;
    }

  private:
    struct Entry {
        double weight;
        double detail_step;
        PieceKind kind;
        bool operator<(const Entry& other) const {
            if (weight != other.weight) return weight < other.weight;
            // The farthest from its end comes first: a kind is split once, after all that lead to it.
            return std::tie(kind.steps, detail_step, kind.node) <
                   std::tie(other.kind.steps, other.detail_step, other.kind.node);
        }
    };

    struct Bucket {
        double count = 0;
        std::vector<Piece> pieces;
        std::optional<MeshKind> mesh; ///< mesh of its pieces; weights may be told apart less finely later
        double triangles = 0;         ///< triangles that its pieces ask of the mesh
    };

    bool fits(const Choice& choice) const { return choice.bytes <= most_bytes_; }

    bool is_better(const Choice& now, const Choice& best) const {
        if (fits(now) != fits(best)) return fits(now);
        return fits(now) ? now.text < best.text : now.bytes < best.bytes || !std::isfinite(best.bytes);
    }

    /// Judges by the placements there are: there will never be fewer.
    bool may_get_better(const Choice& best) const {
        const double bytes = placements_ * placement_bytes_;
        if (fits(best)) return bytes <= most_bytes_ && placements_ * placement_text_ <= best.text;
        return bytes <= best.bytes;
    }

    PieceKind kind_of(const Piece& piece) const {
        return grained(weights_.normalised(graftal::kind_of(cut_, projection_, piece)));
    }

    /// To the nearest, so that what is counted level by level does not drift.
    PieceKind grained(PieceKind kind) const {
        if (kind.unit_step == PieceKind::tiny || kind.unit_step == PieceKind::endless_detail) return kind;
        const double steps = std::round(static_cast<double>(kind.unit_step) / grain_) * grain_;
        kind.unit_step = static_cast<std::int32_t>(steps);
        return kind;
    }

    MeshKind mesh_kind(const PieceKind& kind) const {
        return {symmetry_.representative[kind.node], kind.steps, weights_.mesh_bin(kind)};
    }

    bool splits(const PieceKind& kind) {
        return weights_.of(kind).leaves > 1 && !cut_.nodes[kind.node].sealed && !weights_.is_shell(kind);
    }

    Bucket& bucket_for(const PieceKind& kind) {
        const auto [place, added] = buckets_.try_emplace(kind);
        if (added) {
            const Weights::Weight weight = weights_.of(kind);
            if (splits(kind))
                queue_.push(
                    {cut_.nodes[kind.node].unbounded ? std::numeric_limits<double>::max() : weight.triangles,
                     weights_.detail_step(kind), kind});
            place->second.triangles = weight.triangles;
            if (weight.leaves > 1) add_mesh(place->second.mesh.emplace(mesh_kind(kind)), weight.triangles);
        }
        return place->second;
    }

    /// A mesh is as fine as the finest of its pieces asks for.
    void add_mesh(const MeshKind& kind, double triangles) {
        LiveMesh& mesh = live_meshes_[kind];
        const double before = mesh.triangles();
        mesh.asked.insert(triangles);
        if (triangles > before) triangles_ += triangles - before;
        most_triangles_ = std::max(most_triangles_, triangles_);
    }

    void drop_mesh(const MeshKind& kind, double triangles) {
        LiveMesh& mesh = live_meshes_[kind];
        mesh.asked.erase(mesh.asked.find(triangles));
        if (!(triangles > mesh.triangles())) return; // others are as fine
        triangles_ -= triangles - mesh.triangles();
        // A rest after subtracting far larger numbers, or infinities, is noise: summed anew.
        if (!(triangles_ >= 1e-3 * most_triangles_)) {
            triangles_ = 0;
            for (const auto& [key, live] : live_meshes_)
                triangles_ += live.triangles();
            most_triangles_ = triangles_;
        }
    }

    void add_piece(const Piece& piece) {
        pieces_ += 1;
        if (projection_.drops(world_ball(cut_, piece)) && !cut_.nodes[piece.node].unbounded) return;
        Bucket& bucket = bucket_for(kind_of(piece));
        bucket.count += 1;
        placements_ += 1;
        bucket.pieces.push_back(piece);
    }

    void split(const PieceKind& kind) {
        const double before = pieces_;
        split_pieces(kind);
        if (meter_) meter_->add(static_cast<std::uint64_t>(pieces_ - before));
    }

    void split_pieces(const PieceKind& kind) {
        auto node = buckets_.extract(kind);
        if (node.empty()) return;
        const Bucket& bucket = node.mapped();
        placements_ -= bucket.count;
        if (bucket.mesh) drop_mesh(*bucket.mesh, bucket.triangles);
        const bool cut = weights_.is_cut(kind);
        const DetailNode& split_node = cut_.nodes[kind.node];
        const bool real =
            static_cast<double>(bucket.pieces.size()) == bucket.count &&
            placements_ + bucket.count * static_cast<double>(edge_count(split_node, cut)) <= max_real_pieces;
        for_each_edge(split_node, cut, [&](const DetailEdge& edge) {
            if (real) {
                for (const Piece& piece : bucket.pieces)
                    add_piece(descend(cut_, piece, edge, cut));
            } else {
                bucket_for(grained(weights_.child_kind(kind, edge))).count += bucket.count;
                placements_ += bucket.count;
                pieces_ += 1;
            }
        });
    }

    Choice current(double threshold) const {
        const double per_triangle = PovrayCosts::triangle + PovrayCosts::vertex + PovrayCosts::normal +
                                    (cut_.tinted ? PovrayCosts::slot : 0);
        const double text_a_triangle =
            SdlLengths::triangle + SdlLengths::normal + (cut_.tinted ? SdlLengths::slot : 0);
        Choice choice;
        choice.threshold = threshold;
        choice.placements = placements_;
        choice.triangles = triangles_;
        choice.text = placements_ * placement_text_ + triangles_ * text_a_triangle;
        choice.bytes = PovrayCosts::base + placements_ * placement_bytes_ + triangles_ * per_triangle;
        return choice;
    }

    const DetailGraph& cut_;
    const Symmetry& symmetry_;
    const Projection& projection_;
    Weights& weights_;
    double most_bytes_;
    double placement_bytes_, placement_text_;
    int grain_ = 1;     ///< kinds' details are multiples of it
    double pieces_ = 0; ///< pieces looked at
    double placements_ = 0;
    double triangles_ = 0;
    double most_triangles_ = 0; ///< since they were last summed
    std::unordered_map<PieceKind, Bucket, PieceKindHash> buckets_;
    struct LiveMesh {
        std::multiset<double> asked; ///< triangles, by the kinds of pieces that it serves now

        double triangles() const { return asked.empty() ? 0 : *asked.rbegin(); }
    };
    std::map<MeshKind, LiveMesh> live_meshes_;
    std::priority_queue<Entry> queue_;
    WorkMeter* meter_;
};

} // namespace

Choice choose_cut(const DetailGraph& cut, const Symmetry& symmetry, const Projection& projection,
                  const Piece& root, Weights& weights, double most_bytes, WorkMeter* meter) {
    return Chooser(cut, symmetry, projection, weights, most_bytes, meter).choose(root);
}

} // namespace graftal
