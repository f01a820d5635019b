#include "compiler/zoom/zoom_scale.h"

#include <cmath>

namespace graftal {

namespace {

const Affine& map_of(const Graph& graph, const GraphStep& step) {
    return graph.objects[step.object].instances[step.instance].parent_from_child;
}

} // namespace

ZoomScale ZoomScale::about_focus(const Graph& graph, const Focus& focus, const Magnification& zoom) {
    ZoomScale scale(graph, focus);
    scale.zoom_ = zoom;
    scale.linear_ = Mat3(zoom.mantissa);
    scale.exponent_ = zoom.exponent;
    scale.normalise();
    return scale;
}

ZoomScale ZoomScale::of_last_object(const Graph& graph, const Focus& focus) {
    ZoomScale scale(graph, focus);
    Affine picture_from_frame;
    std::vector<Affine> from_last = {picture_from_frame};
    for (std::size_t i = focus.path.steps.size(); i-- > 0;) {
        picture_from_frame = picture_from_frame * inverse(map_of(graph, focus.path.steps[i]));
        if (!is_finite(picture_from_frame) || norm(picture_from_frame.linear) > largest) break;
        from_last.push_back(picture_from_frame);
    }
    scale.from_last_ = std::make_shared<const std::vector<Affine>>(std::move(from_last));
    Magnification& zoom = scale.zoom_;
    for (const GraphStep& step : focus.path.steps)
        zoom = zoom * Magnification::of(1 / norm(map_of(graph, step).linear));
    return scale;
}

void ZoomScale::normalise() {
    const double most = largest_entry(linear_);
    if (!(most > 0) || !std::isfinite(most)) return;
    const int shift = std::ilogb(most);
    linear_ = linear_ * std::ldexp(1.0, -shift); // a power of two: without rounding
    exponent_ += shift;
}

void ZoomScale::descend() {
    if (!from_last_) {
        linear_ = linear_ * map_of(*graph_, focus_->path.at(depth_)).linear;
        normalise();
    }
    ++depth_;
}

std::optional<Affine> ZoomScale::picture_from_frame() const {
    if (from_last_) {
        const std::size_t up = focus_->path.steps.size() - depth_;
        return up < from_last_->size() ? std::optional((*from_last_)[up]) : std::nullopt;
    }
    if (exponent_ > std::ilogb(largest)) return std::nullopt;
    Affine map;
    map.linear = linear_ * std::exp2(static_cast<double>(exponent_));
    map.translation = -(map.linear * focus_->at(depth_));
    return map;
}

} // namespace graftal
