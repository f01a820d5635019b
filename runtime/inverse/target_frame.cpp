#include "runtime/inverse/target_frame.h"

#include <algorithm>

namespace graftal {

namespace {

constexpr int most_cells_a_side = 256; ///< of the box around the set

template<typename Back, typename There>
PlaneMap conjugate(const PlaneMap& map, const Back& back, const There& there) {
    const Vec2 image = there(map(back({0, 0})));
    return {map.a, -map.b, -map.c, map.d, image.x, image.y};
}

} // namespace

Crop cropped(const CellSet& whole) {
    Crop crop;
    int right = 0, bottom = 0;
    crop.left = whole.width;
    crop.top = whole.height;
    for (int y = 0; y < whole.height; ++y)
        for (int x = 0; x < whole.width; ++x) {
            if (!whole.at(x, y)) continue;
            crop.left = std::min(crop.left, x);
            crop.top = std::min(crop.top, y);
            right = std::max(right, x + 1);
            bottom = std::max(bottom, y + 1);
        }
    const int width = right - crop.left, height = bottom - crop.top;
    crop.size = (std::max(width, height) + most_cells_a_side - 1) / most_cells_a_side;
    crop.set = CellSet((width + crop.size - 1) / crop.size, (height + crop.size - 1) / crop.size);
    for (int y = crop.top; y < bottom; ++y)
        for (int x = crop.left; x < right; ++x)
            if (whole.at(x, y))
                crop.set.cells[crop.set.index((x - crop.left) / crop.size, (y - crop.top) / crop.size)] =
                    true;
    return crop;
}

TargetFrame::TargetFrame(const PictureCells& picture, const Crop& crop, int room) {
    const double pixels = picture.pixels_per_cell, width = picture.width;
    scale_ = crop.size * pixels / width;
    origin_ = {crop.left * pixels / width - room * scale_,
               (picture.height - crop.top * pixels) / width + room * scale_};
}

PlaneMap TargetFrame::in_model(const PlaneMap& map) const {
    return conjugate(
        map, [this](Vec2 p) { return Vec2((p.x - origin_.x) / scale_, (origin_.y - p.y) / scale_); },
        [this](Vec2 p) { return Vec2(origin_.x + scale_ * p.x, origin_.y - scale_ * p.y); });
}

PlaneMap TargetFrame::in_cells(const PlaneMap& map) const {
    return conjugate(
        map, [this](Vec2 p) { return Vec2(origin_.x + scale_ * p.x, origin_.y - scale_ * p.y); },
        [this](Vec2 p) { return Vec2((p.x - origin_.x) / scale_, (origin_.y - p.y) / scale_); });
}

} // namespace graftal
