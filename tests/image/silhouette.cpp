#include "tests/image/silhouette.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/image/drawing.h"

namespace graftal {

namespace {

/// How far it is from the pixel to the nearest one that is hit.
double distance_to(const Silhouette& other, int x, int y, int reach) {
    int nearest = reach * reach;
    for (int v = std::max(0, y - reach); v <= std::min(other.height - 1, y + reach); ++v)
        for (int u = std::max(0, x - reach); u <= std::min(other.width - 1, x + reach); ++u)
            if (other.at(u, v)) nearest = std::min(nearest, (u - x) * (u - x) + (v - y) * (v - y));
    return std::sqrt(nearest);
}

} // namespace

Silhouette silhouette_of(CompiledModel model, int magnification, std::optional<ImageSize> window) {
    show_pigments(model);
    const ImageSize all = {magnification * model.view.size.width, magnification * model.view.size.height};
    model.view.size = window.value_or(all);
    Camera& camera = model.view.camera;
    const double share = static_cast<double>(model.view.size.width) / all.width;
    camera.width *= share;
    const double half_angle = camera.angle_deg * std::numbers::pi / 360;
    camera.angle_deg = std::atan(share * std::tan(half_angle)) * 360 / std::numbers::pi;
    model.view.sky = {.zenith = Rgb(0.0), .horizon = Rgb(0.0)};
    const Image image = draw(model, SampleFormat::linear16);
    Silhouette result{image.width, image.height, {}};
    const auto channels = static_cast<std::ptrdiff_t>(image.channels);
    for (auto at = image.pixels.begin(); at != image.pixels.end(); at += channels)
        result.hit.push_back(std::any_of(at, at + channels, [](float sample) { return sample > 0; }));
    return result;
}

SilhouetteDifference compare_silhouettes(const Silhouette& a, const Silhouette& b, int reach) {
    SilhouetteDifference result;
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x) {
            result.hit += a.at(x, y);
            if (a.at(x, y) == b.at(x, y)) continue;
            ++result.differing;
            result.distance = std::max(result.distance, distance_to(a.at(x, y) ? b : a, x, y, reach));
        }
    return result;
}

} // namespace graftal
