#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "compiler/detail/graph/detail_graph.h"
#include "compiler/detail/graph/piece_kind.h"
#include "compiler/detail/shell/sizes.h"
#include "compiler/support/control.h"
#include "compiler/support/id_table.h"

namespace graftal {

/// Bytes of an engine's memory that a leaf takes as a placement of its own.
using LeafPrice = double (*)(const Primitive& primitive);

struct WeightOptions {
    LeafPrice leaf_price = nullptr; ///< none: nobody asks for it
    double cube_triangles = 12;     ///< how many of a cube's stay visible in a mesh, on average
    /// Pixels of a detail of 1, which decide how finely curved surfaces are meshed; 0: as coarsely as can be.
    double px = 0;
    double error_px = 0; ///< Projection::error_px()
    int grain = 1;       ///< grain of other weights of this graph, which saves finding it
    /// Kinds that take more, and more than the graph itself, are told apart less finely.
    std::uint64_t most_visits = usual_visits;

    static constexpr std::uint64_t usual_visits = 4'000'000;
};

/// Estimates what an unfolded piece holds, by one memoised sweep: O(edges of the kinds reached), and of those
/// no more than some millions.
class Weights {
  public:
    /// Keeps references to both.
    explicit Weights(const DetailGraph& cut, const WeightOptions& options = {},
                     const Control& control = no_control());

    struct Weight {
        double triangles = 0;
        double leaves = 0;
        double curved_leaves = 0; ///< leaves whose meshes only come near them
        double flat_bytes = 0;    ///< of the engine's memory, where every leaf is a placement of its own
        /// True if somewhere in it more leaves lie in each other than anybody could unfold: a mesh of it
        /// becomes a shell (shell/shell.h).
        bool crowded = false;

        Weight& operator+=(const Weight& other);
        friend Weight operator*(double count, Weight weight) {
            for (double* const sum :
                 {&weight.triangles, &weight.leaves, &weight.curved_leaves, &weight.flat_bytes})
                *sum *= count;
            return weight;
        }
    };

    /// Saturates at infinity; kinds that lead back to themselves without losing detail count as one leaf.
    /// Where there are too many kinds, as many unequal scales make them, details are told apart less finely
    /// from then on.
    Weight of(const PieceKind& kind);

    int grain() const { return grain_; }
    /// Edges of kinds followed so far: what all this costs.
    std::uint64_t visits() const { return visits_; }

    /// Kinds are the same where levels do not matter.
    PieceKind normalised(PieceKind kind) const;

    /// Pieces of congruent nodes, equal steps and equal bins share a mesh. A bin is an octave of leaf counts:
    /// in a strictly self-similar model pieces of one bin unfold alike, in others nearly so.
    std::int32_t mesh_bin(const PieceKind& kind);

    /// The step of the detail of its diameter: what is at most 0 may be culled.
    double detail_step(const PieceKind& kind) const;

    /// Requires a node that is no primitive.
    ShellSizes shell_sizes(NodeId node, std::uint32_t steps);
    /// Whether a shell is drawn of the kind, whatever it costs: rays would walk through all that lies in each
    /// other.
    bool is_shell(const PieceKind& kind);

    /// True if the kind is drawn by its stop edges or proxy.
    bool is_cut(const PieceKind& kind) const;

    /// The kind an edge leads to, without looking at where the piece lies.
    PieceKind child_kind(const PieceKind& parent, const DetailEdge& edge) const;

  private:
    struct Known {
        PieceKind kind;
        Weight weight;
    };
    struct Frame {
        std::uint32_t number = 0;
        std::size_t next_edge = 0;
        Weight sum;
    };

    std::uint32_t number_of(const PieceKind& kind);
    bool weigh(std::uint32_t start);
    bool too_many_kinds() const;
    void forget_kinds();
    Weight of_primitive(const PieceKind& kind) const;
    Weight of_cell(const PieceKind& kind, const EdgeCell& cell);
    void crowd(const PieceKind& kind, Weight& weight) const;
    void squeeze(const PieceKind& kind, Weight& weight) const;

    double price(const Primitive& primitive) const {
        return options_.leaf_price ? options_.leaf_price(primitive) : 0;
    }

    const DetailGraph& cut_;
    WeightOptions options_;
    WorkMeter meter_;
    Weight proxy_;
    std::vector<double> diameter_step_; ///< by node
    std::vector<double> cut_step_;      ///< by node, of cut_detail()
    std::vector<bool> flat_;            ///< by node
    int grain_;                         ///< steps of details that are not told apart
    std::map<std::pair<NodeId, std::uint32_t>, ShellSizes> shell_sizes_;
    std::vector<Known> known_;
    IdTable numbers_; ///< of known kinds
    std::vector<Frame> stack_;
    std::uint64_t edges_ = 0;                      ///< of the graph
    std::uint64_t visits_ = 0, visits_before_ = 0; ///< all; those when kinds were last forgotten
};

} // namespace graftal
