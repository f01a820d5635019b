#include "compiler/environment/environment.h"

#include <algorithm>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace graftal {

namespace {

class Regions : public GrowthEnvironment {
  public:
    explicit Regions(const EnvironmentSettings& settings) : regions_(settings.regions) {}

    bool answer(std::span<EnvironmentQuery> queries) override {
        for (const EnvironmentQuery& query : queries) {
            if (query.values.empty()) continue;
            double least = regions_.front().distance(query.place);
            for (const EnvironmentRegion& region : regions_)
                least = std::min(least, region.distance(query.place));
            query.values[0] = least;
        }
        return true;
    }

  private:
    std::vector<EnvironmentRegion> regions_; ///< not empty
};

} // namespace

double EnvironmentRegion::distance(Vec3 place) const {
    switch (kind) {
    case Kind::sphere:
        return glm::length(place - a) - extent;
    case Kind::half_space:
        return glm::dot(a, place) - extent;
    case Kind::box:
        break;
    }
    const Vec3 beyond = glm::max(a - place, place - b);
    const double inside = std::min(0.0, std::max({beyond.x, beyond.y, beyond.z}));
    return glm::length(glm::max(beyond, Vec3(0.0))) + inside;
}

bool EnvironmentBudget::take(std::uint64_t work) {
    if (work <= left_) {
        left_ -= work;
        return true;
    }
    left_ = 0;
    if (!said_)
        diagnostics_
            .error(span_, fmt::format("this environment takes more than {} looks at what is near",
                                      max_environment_work))
            .with_hint("use fewer steps, fewer queries, or smaller distances");
    said_ = true;
    return false;
}

std::unique_ptr<GrowthEnvironment> make_regions(const EnvironmentSettings& settings) {
    return std::make_unique<Regions>(settings);
}

std::unique_ptr<GrowthEnvironment> make_environment(const EnvironmentSettings& settings,
                                                    Diagnostics& diagnostics) {
    switch (settings.kind) {
    case EnvironmentSettings::Kind::crowd:
        return make_crowd(settings, diagnostics);
    case EnvironmentSettings::Kind::rivals:
        return make_rivals(settings, diagnostics);
    case EnvironmentSettings::Kind::shade:
        return make_shade(settings, diagnostics);
    case EnvironmentSettings::Kind::shadows:
        return make_shadows(settings, diagnostics);
    case EnvironmentSettings::Kind::points:
        return make_points(settings, diagnostics);
    case EnvironmentSettings::Kind::regions:
        break;
    }
    return make_regions(settings);
}

} // namespace graftal
