#include "runtime/trace/shade/optics.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/exponential.hpp>

namespace graftal {

namespace {

double squared(double x) {
    return x * x;
}

} // namespace

double fresnel(double ior, double cosine) {
    const double square = ior * ior + cosine * cosine - 1;
    if (!(square > 0)) return 1;
    const double g = std::sqrt(square);
    const double across = 0.5 * squared((g - cosine) / (g + cosine));
    const double ratio = (cosine * (g + cosine) - 1) / (cosine * (g - cosine) + 1);
    return std::clamp(across * (1 + ratio * ratio), 0.0, 1.0);
}

Rgb metal_colour(double metallic, Rgb rgb, double cosine) {
    const double angle = std::acos(std::clamp(cosine, -1.0, 1.0)) / (std::numbers::pi / 2);
    const double white = std::clamp(0.014567225 / squared(angle - 1.12) - 0.011612903, 0.0, 1.0);
    return Rgb(1.0) + metallic * (1 - white) * (rgb - Rgb(1.0));
}

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
