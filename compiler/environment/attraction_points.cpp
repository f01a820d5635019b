#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "compiler/environment/cell_grid.h"
#include "compiler/environment/environment.h"
#include "compiler/support/counter_random.h"

// Points of free space that attract what grows: Runions, Lane and Prusinkiewicz 2007, "Modeling trees with a
// space colonization algorithm".

namespace graftal {

namespace {

class AttractionPoints : public GrowthEnvironment {
  public:
    AttractionPoints(const EnvironmentSettings& settings, std::vector<Vec3> points, Diagnostics& diagnostics)
        : points_(std::move(points)), influence_(settings.influence), kill_(settings.kill),
          budget_(diagnostics, settings.span) {}

    /// Each point attracts the query that is the nearest within its influence, and is gone once one comes
    /// close.
    bool answer(std::span<EnvironmentQuery> queries) override {
        CellGrid grid(std::max(influence_, kill_));
        for (std::uint32_t i = 0; i < queries.size(); ++i)
            grid.add(queries[i].place, i);
        std::vector<double> counts(queries.size());
        std::vector<Vec3> directions(queries.size(), Vec3(0.0));
        std::vector<Vec3> left;
        for (const Vec3& point : points_) {
            double least = std::numeric_limits<double>::infinity();
            std::uint32_t nearest = 0;
            std::uint64_t looks = 1;
            grid.near(point, [&](std::uint32_t i) {
                ++looks;
                const double distance = glm::length(point - queries[i].place);
                if (distance < least) {
                    least = distance;
                    nearest = i;
                }
                return true;
            });
            if (!budget_.take(looks)) return false;
            if (least <= kill_) continue;
            left.push_back(point);
            if (least > influence_) continue;
            counts[nearest] += 1;
            directions[nearest] += (point - queries[nearest].place) / least;
        }
        points_ = std::move(left);
        for (std::size_t i = 0; i < queries.size(); ++i) {
            const double length = glm::length(directions[i]);
            const Vec3 direction = length > 0 ? directions[i] / length : Vec3(0.0);
            const double answers[] = {counts[i], direction.x, direction.y, direction.z};
            for (std::size_t k = 0; k < std::min<std::size_t>(4, queries[i].values.size()); ++k)
                queries[i].values[k] = answers[k];
        }
        return true;
    }

  private:
    std::vector<Vec3> points_;
    double influence_, kill_;
    EnvironmentBudget budget_;
};

} // namespace

/// The points lie evenly in the regions, by chance.
std::unique_ptr<GrowthEnvironment> make_points(const EnvironmentSettings& settings,
                                               Diagnostics& diagnostics) {
    Vec3 low(std::numeric_limits<double>::infinity()), high = -low;
    for (const EnvironmentRegion& region : settings.regions) {
        const bool box = region.kind == EnvironmentRegion::Kind::box;
        low = glm::min(low, box ? region.a : region.a - region.extent);
        high = glm::max(high, box ? region.b : region.a + region.extent);
    }
    constexpr std::uint64_t most_tries_each = 100;
    EnvironmentBudget budget(diagnostics, settings.span);
    const CounterRandom random = CounterRandom(settings.seed).sequence(UINT64_MAX - 2);
    std::vector<Vec3> points;
    for (std::uint64_t i = 0; points.size() < settings.point_count; ++i) {
        if (i == most_tries_each * settings.point_count) {
            diagnostics.error(settings.span, "the regions fill too little of the box about them for points");
            return nullptr;
        }
        if (!budget.take(settings.regions.size())) return nullptr;
        Vec3 point;
        for (int axis = 0; axis < 3; ++axis)
            point[axis] = glm::mix(low[axis], high[axis],
                                   CounterRandom::unit(random(3 * i + static_cast<std::uint64_t>(axis))));
        if (std::ranges::any_of(settings.regions,
                                [&](const EnvironmentRegion& region) { return region.distance(point) <= 0; }))
            points.push_back(point);
    }
    return std::make_unique<AttractionPoints>(settings, std::move(points), diagnostics);
}

} // namespace graftal
