#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "compiler/environment/cell_grid.h"
#include "compiler/environment/environment.h"

// Light that comes through balls of leaves: Chiba, Ohkawa, Muraoka and Miura 1994, "Visual simulation of
// botanical trees based on virtual heliotropism and dormancy break".

namespace graftal {

namespace {

constexpr std::size_t sky_directions = 64;

/// A vector at right angles to a unit vector.
Vec3 across(Vec3 direction) {
    const Vec3 other = std::abs(direction.x) < 0.6 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
    return glm::normalize(glm::cross(direction, other));
}

/// Spread evenly over the hemisphere, by the golden angle.
std::vector<EnvironmentSource> uniform_sky() {
    std::vector<EnvironmentSource> sky;
    for (std::size_t i = 0; i < sky_directions; ++i) {
        const double height = (static_cast<double>(i) + 0.5) / sky_directions;
        const double turn = static_cast<double>(i) * std::numbers::pi * (3 - std::sqrt(5.0));
        const double level = std::sqrt(1 - height * height);
        sky.push_back({Vec3(-level * std::sin(turn), height, -level * std::cos(turn)), 1.0 / sky_directions});
    }
    return sky;
}

/// The area that two discs share whose centres lie this far apart.
double shared_area(double a, double b, double distance) {
    if (distance >= a + b) return 0;
    const double small = std::min(a, b), large = std::max(a, b);
    if (distance + small <= large) return std::numbers::pi * small * small;
    const double to_large = (distance * distance + large * large - small * small) / (2 * distance);
    const double to_small = distance - to_large;
    const auto segment = [](double radius, double height) {
        const double cosine = std::clamp(height / radius, -1.0, 1.0);
        return radius * radius * (std::acos(cosine) - cosine * std::sqrt(1 - cosine * cosine));
    };
    return segment(large, to_large) + segment(small, to_small);
}

/// A ball for each query, of the radius that it tells. The query hears, for each direction, the share of its
/// disc that others leave free. A ball that covers a share takes that away, except for its transmittance.
class Shade : public GrowthEnvironment {
  public:
    Shade(const EnvironmentSettings& settings, Diagnostics& diagnostics)
        : transmittance_(settings.transmittance),
          sources_(settings.sources.empty() ? uniform_sky() : settings.sources),
          budget_(diagnostics, settings.span) {}

    bool answer(std::span<EnvironmentQuery> queries) override {
        std::vector<double> radii;
        double largest = 0;
        for (const EnvironmentQuery& query : queries) {
            radii.push_back(query.values.empty() ? 0 : std::abs(query.values[0]));
            largest = std::max(largest, radii.back());
        }
        std::vector<double> light(queries.size());
        std::vector<Vec3> brightest(queries.size(), Vec3(0.0));
        for (const EnvironmentSource& source : sources_) {
            // Seen along the direction, what covers a disc lies near it.
            const Vec3 x = across(source.direction), y = glm::cross(source.direction, x);
            std::vector<Vec3> seen;
            CellGrid grid(largest > 0 ? 2 * largest : 1);
            for (std::uint32_t i = 0; i < queries.size(); ++i) {
                const Vec3 place = queries[i].place;
                seen.emplace_back(glm::dot(place, x), glm::dot(place, y), 0);
                grid.add(seen.back(), i);
            }
            for (std::uint32_t i = 0; i < queries.size(); ++i) {
                double share = 1;
                std::uint64_t looks = 1;
                grid.near(seen[i], [&](std::uint32_t j) {
                    ++looks;
                    const bool before =
                        i != j && glm::dot(source.direction, queries[j].place - queries[i].place) >= 0;
                    if (before)
                        share *= 1 - (1 - transmittance_) * covered(radii[i], radii[j], seen[i], seen[j]);
                    return true;
                });
                if (!budget_.take(looks)) return false;
                light[i] += source.intensity * share;
                brightest[i] += source.intensity * share * source.direction;
            }
        }
        for (std::size_t i = 0; i < queries.size(); ++i)
            tell(queries[i], light[i], brightest[i]);
        return true;
    }

  private:
    static double covered(double own, double other, Vec3 own_place, Vec3 other_place) {
        if (!(own > 0)) return glm::length(own_place - other_place) < other ? 1 : 0;
        return shared_area(own, other, glm::length(own_place - other_place)) / (std::numbers::pi * own * own);
    }

    static void tell(const EnvironmentQuery& query, double light, Vec3 brightest) {
        const double length = glm::length(brightest);
        const Vec3 direction = length > 0 ? brightest / length : Vec3(0.0);
        const double answers[] = {light, direction.x, direction.y, direction.z};
        const std::size_t count = query.values.size() < 4 ? 1 : 4;
        for (std::size_t k = 0; k < std::min(count, query.values.size()); ++k)
            query.values[k] = answers[k];
    }

    double transmittance_;
    std::vector<EnvironmentSource> sources_;
    EnvironmentBudget budget_;
};

} // namespace

std::unique_ptr<GrowthEnvironment> make_shade(const EnvironmentSettings& settings, Diagnostics& diagnostics) {
    return std::make_unique<Shade>(settings, diagnostics);
}

} // namespace graftal
