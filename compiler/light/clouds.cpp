#include "compiler/light/clouds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "compiler/light/longitude.h"
#include "compiler/support/angle.h"
#include "compiler/support/check.h"

namespace graftal {

namespace {

// Lengths are in heights of the layer above the eye.
constexpr double planet_radius = 500;
constexpr double largest_cloud = 1.5; ///< wavelength of the coarsest noise
constexpr int octaves = 8;
constexpr double seen_through_air = 14; ///< the distance at which a third of a cloud's light is left

std::uint32_t mixed(std::uint32_t x) {
    x = (x ^ (x >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    return x ^ (x >> 16);
}

/// Unit vectors all round.
const std::array<glm::dvec2, 64>& slopes() {
    static const std::array<glm::dvec2, 64> all = [] {
        std::array<glm::dvec2, 64> made;
        for (std::size_t i = 0; i < made.size(); ++i) {
            const double turn =
                2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(made.size());
            made[i] = {std::cos(turn), std::sin(turn)};
        }
        return made;
    }();
    return all;
}

/// A number in [-1, 1]: 0 on the points of the lattice, and smooth between them.
double gradient_noise(glm::dvec2 at, std::uint32_t seed) {
    const glm::dvec2 corner = glm::floor(at), f = at - corner;
    const auto& table = slopes();
    const auto slope = [&](int i, int j) {
        const auto x = static_cast<std::uint32_t>(static_cast<std::int64_t>(corner.x) + i);
        const auto y = static_cast<std::uint32_t>(static_cast<std::int64_t>(corner.y) + j);
        return glm::dot(table[mixed(x + mixed(y + seed * 0x9e3779b9u)) % table.size()], f - glm::dvec2(i, j));
    };
    const glm::dvec2 s = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    const double low = glm::mix(slope(0, 0), slope(1, 0), s.x),
                 high = glm::mix(slope(0, 1), slope(1, 1), s.x);
    return std::numbers::sqrt2 * glm::mix(low, high, s.y);
}

/// The octaves of height_of(): the weight of each, and the most that those from each on add.
struct Octaves {
    static constexpr int smooth = 2;      ///< the coarsest ones are noise; the others fold it
    static constexpr double crest = 0.45; ///< where a fold lies

    std::array<double, octaves> weight;
    std::array<double, octaves + 1> most_left{};

    constexpr Octaves() : weight{1} {
        for (int i = 1; i < octaves; ++i)
            weight[i] = weight[i - 1] * (i < smooth ? 0.6 : 0.52);
        for (int i = octaves - 1; i >= 0; --i)
            most_left[i] = most_left[i + 1] + weight[i] * (i < smooth ? 1 : crest);
    }
};

/// The thickness of the layer, before a threshold cuts it: towers where the noise folds. Wavelengths fade
/// out that a texel is too wide for. Any number less than `least`, if it is less.
double height_of(glm::dvec2 at, double texel, double least) {
    static constexpr Octaves of;
    // Bends the rest, so that no lattice shows.
    const glm::dvec2 bend(gradient_noise(at / largest_cloud + 7.3, 101),
                          gradient_noise(at / largest_cloud - 4.1, 102));
    at += 0.35 * largest_cloud * bend;
    double sum = 0, wavelength = largest_cloud;
    for (int i = 0; i < octaves && wavelength > 2 * texel && sum + of.most_left[i] > least; ++i) {
        const double kept = std::min(1.0, wavelength / (2 * texel) - 1);
        const double noise = gradient_noise(at / wavelength, static_cast<std::uint32_t>(i));
        sum += kept * of.weight[i] * (i < Octaves::smooth ? noise : Octaves::crest - 1.6 * std::abs(noise));
        wavelength *= 0.48;
    }
    return sum;
}

/// The height that so large a share of the layer exceeds.
double threshold_of(double cover) {
    constexpr int side = 96;
    constexpr double apart = 0.737 * largest_cloud;
    constexpr double lowest = -1e9;
    std::vector<double> heights;
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j)
            heights.push_back(height_of({i * apart, j * apart + 0.31 * i}, 1e-3, lowest));
    std::ranges::sort(heights);
    const auto last = static_cast<double>(heights.size() - 1);
    return heights[static_cast<std::size_t>(std::lround((1 - cover) * last))];
}

/// Where the eye meets the layer: how far away, and where over the ground.
struct Meeting {
    double distance;
    glm::dvec2 at;

    explicit Meeting(Vec3 direction) {
        const double b = planet_radius * direction.y;
        distance = std::sqrt(b * b + 2 * planet_radius + 1) - b;
        at = distance * glm::dvec2(direction.x, direction.z);
    }
};

struct Layer {
    const SkyLight& sky;
    Clouds clouds;
    double threshold;
    Rgb ambient;
    std::pair<double, double> turn; ///< cosine and sine

    Layer(const SkyLight& over, const Clouds& what)
        : sky(over), clouds(what), threshold(threshold_of(what.cover)), ambient(over.on_paper()),
          turn(cos_sin_deg(what.turn_deg)) {}

    glm::dvec2 turned(glm::dvec2 p) const {
        const auto [cosine, sine] = turn;
        return {cosine * p.x - sine * p.y, sine * p.x + cosine * p.y};
    }

    /// Optical, straight upwards.
    double thickness(glm::dvec2 at, double texel) const {
        constexpr double densest = 11, frayed = 0.12; // edges thin out
        const double over = std::max(0.0, height_of(turned(at), texel, threshold) - threshold);
        return densest * over * over / (over + frayed);
    }

    /// A texel stands for a long piece of the layer where it is seen aslant, and is looked at in as many
    /// places.
    Rgb texel(double u, double from_zenith, double texel_rad) const {
        constexpr double most = 6;
        const int looks = static_cast<int>(std::lround(std::min(most, 1 / std::cos(from_zenith))));
        Rgb sum(0.0);
        for (int i = 0; i < looks; ++i) {
            const double at = from_zenith + texel_rad * ((i + 0.5) / looks - 0.5);
            sum += radiance(direction_at(u, std::cos(at)), texel_rad) / static_cast<double>(looks);
        }
        return sum;
    }

    Rgb radiance(Vec3 direction, double texel_rad) const {
        const Rgb clear = sky.radiance(direction);
        const Meeting meeting(direction);
        const double steep = std::max(direction.y, 0.08);
        const double texel = texel_rad * meeting.distance;
        const double tau = thickness(meeting.at, texel);
        if (tau <= 0) return clear;
        const double opacity = 1 - std::exp(-tau / std::sqrt(steep));
        const Rgb shown = glm::mix(horizon(direction), lit(direction, meeting, tau, texel),
                                   std::exp(-meeting.distance / seen_through_air));
        return glm::mix(clear, shown, opacity);
    }

  private:
    Rgb horizon(Vec3 direction) const {
        return sky.radiance(glm::normalize(Vec3(direction.x, 0.02, direction.z)));
    }

    Rgb lit(Vec3 direction, const Meeting& meeting, double tau, double texel) const {
        const Vec3 sun = clouds.to_sun;
        // Towards the sun: its low light passes more of the layer.
        const glm::dvec2 level(sun.x, sun.z);
        const double slant = std::min(3.0, glm::length(level) / std::max(sun.y, 0.1));
        constexpr double look = 0.09;
        const glm::dvec2 step =
            glm::length(level) > 0 ? look * slant * glm::normalize(level) : glm::dvec2(0.0);
        double before = 0;
        constexpr int steps = 3;
        for (int i = 1; i <= steps; ++i)
            before += thickness(meeting.at + static_cast<double>(i) * step, std::max(texel, look)) / steps;
        const double reaches = 0.3 + 0.7 * std::exp(-0.45 * before);
        const double through = 0.42 + 0.58 * std::exp(-0.35 * tau);
        constexpr double g = 0.75;
        const double cosine = glm::dot(direction, sun);
        const double forward = (1 - g * g) / std::pow(1 + g * g - 2 * g * cosine, 1.5);
        const double glow = 0.12 * forward * std::exp(-0.9 * tau);
        return (0.8 * reaches * through + glow) * clouds.sun_rgb + 0.75 * through * ambient;
    }
};

} // namespace

std::shared_ptr<const SkyPicture> cloudy_picture(const SkyLight& sky, const Clouds& clouds, int rows,
                                                 const CancelFlag& cancel) {
    GRAFTAL_CHECK(!sky.picture && sky.up == Vec3(0, 1, 0),
                  "cloudy_picture: an upright sky without a picture");
    const Layer layer(sky, clouds);
    const int columns = 2 * rows;
    std::vector<SkyPicture::Texel> texels;
    texels.reserve(static_cast<std::size_t>(columns) * rows);
    for (int row = 0; row < rows; ++row) {
        if (cancel.raised()) throw Cancelled();
        for (int column = 0; column < columns; ++column) {
            const double from_zenith = std::numbers::pi * (row + 0.5) / rows, u = (column + 0.5) / columns;
            const Rgb light = row < rows / 2 ? layer.texel(u, from_zenith, std::numbers::pi / rows)
                                             : sky.radiance(direction_at(u, std::cos(from_zenith)));
            const glm::vec3 texel(glm::clamp(light, Rgb(0.0), Rgb(most_radiance)));
            texels.push_back({texel.r, texel.g, texel.b});
        }
    }
    return std::make_shared<const SkyPicture>(columns, rows, std::move(texels));
}

int cloud_rows(double work_seconds) {
    constexpr double share = 1.0 / 6;
    constexpr double whole_s = 2.5; // of a sky with many clouds, at most_cloud_rows
    int rows = most_cloud_rows;
    for (double seconds = whole_s; rows > 128 && seconds > share * work_seconds; seconds /= 4)
        rows /= 2;
    return rows;
}

CloudPictures::Drawing::Drawing(CloudPictures& pictures, int rows, CancelFlag cancel)
    : pictures_(pictures), rows_(rows) {
    pictures_.set(rows, std::move(cancel));
}

CloudPictures::Drawing::~Drawing() {
    pictures_.set(rows_, {});
}

void CloudPictures::set(int rows, CancelFlag cancel) {
    const std::lock_guard lock(mutex_);
    rows_ = rows;
    cancel_ = std::move(cancel);
}

std::shared_ptr<const SkyPicture> CloudPictures::picture(const SkyLight& sky, const Clouds& clouds) {
    const std::lock_guard lock(mutex_);
    std::shared_ptr<const SkyPicture> picture = picture_.lock();
    if (picture && sky_ == sky && clouds_ == clouds && picture_rows_ == rows_) return picture;
    picture = cloudy_picture(sky, clouds, rows_, cancel_);
    picture_rows_ = rows_;
    sky_ = sky;
    clouds_ = clouds;
    picture_ = picture;
    return picture;
}

} // namespace graftal
