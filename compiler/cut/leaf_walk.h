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
    double scale = 1; ///< norm of the linear part
    Rgb rgb{0.8};     ///< opaque, all tints of the walk in front
    std::optional<MaterialId> material;
    double culled_detail = 0; ///< > 0: it stands for a part of that detail
};

/// Visits the leaves of a baked subtree in one fixed order: geometry as the representative has it, colours as
/// the painter's node has them. The order does not depend on the painter.
class LeafWalk {
  public:
    LeafWalk(const CutGraph& cut, const Symmetry& symmetry, const BakeRequest& request,
             const Painter& painter);

    /// The next leaf, or false at the end. Memory O(depth).
    bool next(WalkedLeaf& leaf);

  private:
    struct Visit {
        std::uint32_t pair;
        std::uint32_t steps;
        Affine representative_from_node;
        double scale;
        PathTint tint;
        Rgb inherited;
        std::optional<MaterialId> material;
        double culled_detail;
    };

    void push_children(const Visit& visit, bool is_cut, double detail);

    const CutGraph& cut_;
    const Symmetry& symmetry_;
    double detail_per_unit_;
    std::vector<Visit> stack_;
};

} // namespace graftal
