#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "compiler/detail/baked.h"
#include "compiler/detail/graph/alike_set.h"
#include "compiler/detail/graph/symmetry.h"
#include "compiler/detail/mesh/limit_normal.h"

namespace graftal {

/// One leaf met by a LeafWalk.
struct WalkedLeaf {
    Primitive primitive = PrimitiveKind::sphere;
    Affine representative_from_leaf;
    std::vector<Rgb> colours;           ///< by painter; opaque, all tints of the walk in front
    std::optional<MaterialId> material; ///< by the first painter
    double culled_detail = 0;           ///< > 0: it stands for a part of that detail
    bool crushed = false;               ///< by a singular map
    bool faint = false;                 ///< of a set without area (least_width.h)
    NormalField normals;                ///< of a proxy, in the representative's frame, if asked for
    bool proxy = false;
    double light_share = 1; ///< share of the light on it (self_shadow.h)
    PathTint tint;          ///< all tints of the walk, by the first painter
    double turns = 1;       ///< length_in_turns() of its instance
};

/// Visits the leaves of a baked subtree in one fixed order: geometry as the representative has it, colours as
/// the painters' nodes have them. The order does not depend on the painters. Where parts of sets without area
/// pile up, one of those that lie alike to a quarter of a pixel stands for all.
class LeafWalk {
  public:
    /// `painters`: of the request, the first or all.
    LeafWalk(const DetailGraph& cut, const Symmetry& symmetry, const BakeRequest& request,
             std::span<const Painter> painters);

    /// The next leaf, or false at the end. Memory: the parts that wait, with a colour for each painter, and
    /// the parts of sets without area that were told apart.
    bool next(WalkedLeaf& leaf);
    /// Nodes and leaves so far, and what comparing them took.
    std::uint64_t visits() const { return visits_; }

  private:
    struct Visit {
        NodeId shape = 0;
        std::uint32_t steps = 0;
        Affine representative_from_node;
        double scale = 1; ///< norm of the linear part
        double culled_detail = 0;
        bool crushed = false;
        bool faint = false;
        std::uint32_t depth = 0; ///< unending nodes above it
        double turns = 1;        ///< of a primitive
        double light_share = 1;
    };
    /// The colours that one painter gives to a visit.
    struct Painted : Look {
        std::uint32_t pair = 0;
    };

    const DetailNode& colours_of(const Painted& paint) const {
        return cut_.nodes[symmetry_.pairs[paint.pair].b];
    }
    void pop();
    void enter_ball(const DetailNode& shape);
    NormalField normals() const;
    double light_share(double detail) const;
    void push_children(bool is_cut, double detail);
    void push_items();
    bool is_new(const Visit& child);
    // Where they lie: to build them elsewhere and to copy them would take twice the time.
    void fill_child(const DetailEdge& edge, bool is_cut, double detail, Visit& child) const;
    void fill_child(const Painted& paint, std::size_t edge, bool is_cut, Painted& child) const;

    const DetailGraph& cut_;
    const Symmetry& symmetry_;
    double detail_per_unit_;
    double error_px_;
    const SelfShadows* self_shadows_;
    bool limit_normals_;
    std::vector<Visit> stack_;
    std::vector<Painted> paint_stack_; ///< one a painter for each visit
    Visit visit_;                      ///< the last one popped
    std::vector<Ball> balls_;          ///< of the unending nodes above it, from the root on
    std::vector<Painted> paints_;
    std::uint64_t visits_ = 0;
    Mat3 cells_from_unit_; ///< within which parts lie alike; all zero: none do
    AlikeSet met_;
};

} // namespace graftal
