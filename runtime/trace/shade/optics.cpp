#include "runtime/trace/shade/optics.h"

#include <algorithm>

#include <glm/exponential.hpp>

namespace graftal {

double Inside::relative_ior(const Interior& interior) const {
    if (count_ == 0) return interior.ior;
    if (!find(interior)) return interior.ior / last().ior;
    return (count_ == 1 ? 1 : last().ior) / interior.ior;
}

double Inside::cross(const Interior& interior) {
    if (const Interior* const known = find(interior)) {
        const bool innermost = known == &last();
        remove(known);
        if (!innermost) return 1;
        return interior.ior / (count_ == 0 ? 1 : last().ior);
    }
    const double outer = count_ == 0 ? 1 : last().ior;
    if (count_ == solids_.size()) return 1;
    solids_[count_++] = interior;
    return outer / interior.ior;
}

Rgb Inside::left_after(double length) const {
    Rgb depth(0.0);
    for (std::size_t i = 0; i < count_; ++i)
        depth += solids_[i].absorbed;
    return depth == Rgb(0.0) ? Rgb(1.0) : glm::exp(-length * depth);
}

const Interior* Inside::find(const Interior& interior) const {
    const auto* const end = solids_.data() + count_;
    const auto* const found = std::find(solids_.data(), end, interior);
    return found == end ? nullptr : found;
}

void Inside::remove(const Interior* interior) {
    std::copy(interior + 1, static_cast<const Interior*>(solids_.data() + count_),
              solids_.begin() + (interior - solids_.data()));
    --count_;
}

} // namespace graftal
