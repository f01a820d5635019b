#include "runtime/points/tone.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace graftal {

namespace {

double linear_of(double srgb) {
    return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}

Rgb linear_of(Rgb srgb) {
    return {linear_of(srgb.r), linear_of(srgb.g), linear_of(srgb.b)};
}

/// What the background shows through each pixel.
class Backdrop {
  public:
    explicit Backdrop(const View& view) : view_(view) {
        half_width_ = std::tan(view.camera.angle_deg * std::numbers::pi / 360);
        plain_ = view.camera.orthographic || view.sky.zenith == view.sky.horizon;
    }

    Rgb at(int x, int y) const {
        const Camera& camera = view_.camera;
        if (plain_) return view_.sky.colour(camera.direction);
        const double step = 2 * half_width_ / view_.size.width;
        const Vec3 across = step * ((x + 0.5 - 0.5 * view_.size.width) * camera.right -
                                    (y + 0.5 - 0.5 * view_.size.height) * camera.up);
        return view_.sky.colour(glm::normalize(camera.direction + across));
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
        return std::pow(std::min(1.0, std::log1p(factor_ * static_cast<double>(count)) / white_), power_);
    }

  private:
    double factor_ = 1, white_ = 1, power_;
};

} // namespace

Image toned(const Accumulation& points, const Tone& tone, const View& view) {
    const ImageSize size = points.size();
    const Curve curve(points, tone);
    const Backdrop backdrop(view);
    Image image{size.width, size.height, tone.transparent ? 4 : 3, {}};
    image.pixels.reserve(points.cells().size() * static_cast<std::size_t>(image.channels));
    std::size_t pixel = 0;
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x, ++pixel) {
            const Accumulation::Cell& cell = points.cells()[pixel];
            const double cover = curve(cell.count);
            Rgb rgb(0.0);
            if (cover > 0) rgb = tone.by_density ? density_colour(cover) : points.mean_colour(cell);
            if (!tone.transparent) rgb = cover * rgb + (1 - cover) * backdrop.at(x, y);
            for (int c = 0; c < 3; ++c)
                image.pixels.push_back(static_cast<float>(rgb[c]));
            if (tone.transparent) image.pixels.push_back(static_cast<float>(cover));
        }
    return image;
}

Rgb density_colour(double x) {
    // sRGB, even steps of lightness from violet over green to yellow.
    static constexpr std::array<Rgb, 6> scale = {Rgb(0.25, 0.10, 0.45), Rgb(0.22, 0.32, 0.60),
                                                 Rgb(0.13, 0.52, 0.56), Rgb(0.25, 0.70, 0.42),
                                                 Rgb(0.68, 0.84, 0.22), Rgb(1.00, 0.95, 0.55)};
    const double at = std::clamp(x, 0.0, 1.0) * (scale.size() - 1);
    const auto i = std::min(static_cast<std::size_t>(at), scale.size() - 2);
    const double t = at - static_cast<double>(i);
    return linear_of((1 - t) * scale[i] + t * scale[i + 1]);
}

Rgb map_colour(std::uint32_t number) {
    // Hues by the golden section, as leaves stand on a stem.
    const double turn = 0.08 + number * 0.618033988749895;
    Rgb rgb;
    for (int c = 0; c < 3; ++c)
        rgb[c] = 0.62 + 0.36 * std::cos(2 * std::numbers::pi * (turn - c / 3.0));
    return linear_of(rgb);
}

} // namespace graftal
