#include "compiler/detail/shell/point_set.h"

namespace graftal {

PointPaint PointPaint::through(const CutEdge& edge, const CutNode* parent,
                               const std::vector<Material>& materials) const {
    PointPaint seen = *this;
    const auto inherits = [&](Rgb below, double through) {
        for (int k = 0; k < 3; ++k)
            seen.fixed[static_cast<std::size_t>(k)] +=
                static_cast<float>(static_cast<double>(seen.open) * below[k]);
        seen.open *= static_cast<float>(through);
    };
    if (edge.material && seen.material < 0) {
        inherits(materials[*edge.material].rgb, 0);
        seen.material = static_cast<std::int32_t>(*edge.material);
    } else if (parent) {
        inherits(parent->mean.fixed, parent->mean.open);
    }
    const auto through = static_cast<float>(1 - edge.tint.alpha);
    for (int k = 0; k < 3; ++k) {
        float& part = seen.fixed[static_cast<std::size_t>(k)];
        part = static_cast<float>(edge.tint.premultiplied[k]) + through * part;
    }
    seen.open *= through;
    return seen;
}

} // namespace graftal
