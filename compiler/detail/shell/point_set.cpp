#include "compiler/detail/shell/point_set.h"

namespace graftal {

PointPaint PointPaint::above(const LookStep& step) const {
    PointPaint seen = *this;
    for (int k = 0; k < 3; ++k)
        seen.fixed[static_cast<std::size_t>(k)] +=
            static_cast<float>(static_cast<double>(open) * step.inherits.fixed[k]);
    seen.open *= static_cast<float>(step.inherits.open);
    static_cast<Paint&>(seen) = seen.under(Paint(step.tint));
    if (step.material && material < 0) seen.material = static_cast<std::int32_t>(*step.material);
    return seen;
}

} // namespace graftal
