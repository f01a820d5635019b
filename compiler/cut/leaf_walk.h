#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "compiler/cut/bake.h"

namespace graftal {

/// One leaf met by a LeafWalk.
struct WalkedLeaf {
    PrimitiveKind kind = PrimitiveKind::sphere;
    Affine representative_from_leaf;
    std::vector<Rgb> colours;           ///< by painter; opaque, all tints of the walk in front
    std::optional<MaterialId> material; ///< by the first painter
    double culled_detail = 0;           ///< > 0: it stands for a part of that detail
};

/// Visits the leaves of a baked subtree in one fixed order: geometry as the representative has it, colours as
/// the painters' nodes have them. The order does not depend on the painters.
class LeafWalk {
  public:
    LeafWalk(const CutGraph& cut, const Symmetry& symmetry, const BakeRequest& request);

    /// The next leaf, or false at the end. Memory O(depth).
    bool next(WalkedLeaf& leaf);

  private:
    struct Visit {
        NodeId shape;
        std::uint32_t steps;
        Affine representative_from_node;
        double scale; ///< norm of the linear part
        double culled_detail;
    };
    /// What one painter makes of a visit.
    struct Paint {
        std::uint32_t pair;
        PathTint tint;
        Rgb inherited;
        std::optional<MaterialId> material;
    };

    const CutNode& colours_of(const Paint& paint) const { return cut_.nodes[symmetry_.pairs[paint.pair].b]; }
    void pop();
    void push_children(bool is_cut, double detail);
    Visit child_visit(const CutEdge& edge, bool is_cut, double detail) const;
    Paint child_paint(const Paint& paint, std::size_t edge, bool is_cut) const;

    const CutGraph& cut_;
    const Symmetry& symmetry_;
    double detail_per_unit_;
    std::vector<Visit> stack_;
    std::vector<Paint> paint_stack_; ///< as many for each visit as there are painters
    Visit visit_;                    ///< the last one popped
    std::vector<Paint> paints_;
};

} // namespace graftal
