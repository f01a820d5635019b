#include "runtime/points/tone.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "compiler/support/check.h"
#include "compiler/support/srgb.h"
#include "runtime/points/glow.h"

namespace graftal {

namespace {

/// Colours of the background in each pixel.
class Backdrop {
  public:
    explicit Backdrop(const View& view) : view_(view) {
        half_width_ = std::tan(view.camera.angle_deg * std::numbers::pi / 360);
        plain_ = view.camera.orthographic || (!view.shows_sky_light && view.sky.zenith == view.sky.horizon);
    }

    Rgb at(int x, int y) const {
        const Camera& camera = view_.camera;
        if (plain_) return view_.background(camera.direction);
        const double step = 2 * half_width_ / view_.size.width;
        const Vec3 across = step * ((x + 0.5 - 0.5 * view_.size.width) * camera.right -
                                    (y + 0.5 - 0.5 * view_.size.height) * camera.up);
        return view_.background(glm::normalize(camera.direction + across));
    }

  private:
    const View& view_;
    double half_width_;
    bool plain_;
};

/// The numbers that the curve is drawn by.
class Curve {
  public:
    Curve(const Accumulation& points, const Tone& tone) : power_(1 / tone.gamma) {
        std::vector<std::uint64_t> counts;
        double sum = 0;
        for (const Accumulation::Cell& cell : points.cells())
            if (cell.count > 0) {
                counts.push_back(cell.count);
                sum += static_cast<double>(cell.count);
            }
        if (counts.empty()) return;
        const auto high = counts.begin() + static_cast<std::ptrdiff_t>(counts.size() * 95 / 100);
        std::nth_element(counts.begin(), high, counts.end());
        factor_ = tone.exposure * static_cast<double>(counts.size()) / sum;
        white_ = std::log1p(factor_ * static_cast<double>(*high));
    }

    double operator()(std::uint64_t count) const {
        if (count == 0) return 0;
        return std::pow(std::log1p(factor_ * static_cast<double>(count)) / white_, power_);
    }

  private:
    double factor_ = 1, white_ = 1, power_;
};

} // namespace

Image toned(const Accumulation& points, const Tone& tone, const View& view) {
    GRAFTAL_CHECK(!(tone.light && tone.transparent), "toned");
    const ImageSize size = points.size();
    const Curve curve(points, tone);
    const Backdrop backdrop(view);
    const auto ground_at = [&](std::size_t pixel) {
        const auto width = static_cast<std::size_t>(size.width);
        if (tone.ground) return *tone.ground;
        return backdrop.at(static_cast<int>(pixel % width), static_cast<int>(pixel / width));
    };
    const std::vector<Accumulation::Cell>& cells = points.cells();
    Image image{size.width, size.height, tone.transparent ? 4 : 3, {}};
    image.pixels.reserve(cells.size() * static_cast<std::size_t>(image.channels));
    for (std::size_t pixel = 0; pixel < cells.size(); ++pixel) {
        const Accumulation::Cell& cell = cells[pixel];
        const double weight = curve(cell.count);
        const double cover = std::min(1.0, weight);
        Rgb rgb(0.0);
        if (cell.count > 0) rgb = tone.by_density ? tone.scale.at(cover) : points.mean_colour(cell);
        if (tone.light)
            rgb *= weight;
        else if (!tone.transparent)
            rgb = cover * rgb + (1 - cover) * ground_at(pixel);
        for (int c = 0; c < 3; ++c)
            image.pixels.push_back(static_cast<float>(rgb[c]));
        if (tone.transparent) image.pixels.push_back(static_cast<float>(cover));
    }
    if (!tone.light) return image;
    if (tone.glow > 0) spread_glow(image, tone.glow);
    for (std::size_t pixel = 0; pixel < cells.size(); ++pixel) {
        const Rgb ground = ground_at(pixel);
        for (std::size_t c = 0; c < 3; ++c)
            image.pixels[3 * pixel + c] += static_cast<float>(ground[static_cast<int>(c)]);
    }
    return image;
}

Rgb map_colour(std::uint32_t number) {
    // Hues by the golden section, as leaves stand on a stem.
    const double turn = 0.08 + number * 0.618033988749895;
    Rgb rgb;
    for (int c = 0; c < 3; ++c)
        rgb[c] = 0.62 + 0.36 * std::cos(2 * std::numbers::pi * (turn - c / 3.0));
    return linear_from_srgb(rgb);
}

} // namespace graftal
