#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "compiler/environment/cell_grid.h"
#include "compiler/environment/environment.h"

// Organs that compete for room: Honda, Tomlinson and Fisher 1981, "Computer simulation of branch interaction
// and regulation by unequal flow rates in botanical trees".

namespace graftal {

namespace {

/// A query tells its strength and, if it will, a group; only those of one group compete.
double value_or_0(const EnvironmentQuery& query, std::size_t k) {
    return k < query.values.size() ? query.values[k] : 0;
}

/// Both kinds: `own_radii`: the strength of a query is the radius of its disc; else all keep the distance of
/// the statement.
class Competition : public GrowthEnvironment {
  public:
    Competition(const EnvironmentSettings& settings, bool own_radii, Diagnostics& diagnostics)
        : radius_(settings.radius), flat_(settings.flat), own_radii_(own_radii),
          budget_(diagnostics, settings.span) {}

    bool answer(std::span<EnvironmentQuery> queries) override {
        double reach = radius_;
        if (own_radii_)
            for (const EnvironmentQuery& query : queries)
                reach = std::max(reach, 2 * std::abs(value_or_0(query, 0)));
        if (!(reach > 0)) reach = 1;
        CellGrid grid(reach);
        std::vector<Vec3> places;
        for (std::uint32_t i = 0; i < queries.size(); ++i) {
            places.push_back(queries[i].place - glm::dot(queries[i].place, flat_) * flat_);
            grid.add(places.back(), i);
        }
        std::vector<double> answers(queries.size(), 1);
        for (std::uint32_t i = 0; i < queries.size(); ++i) {
            std::uint64_t looks = 1;
            grid.near(places[i], [&](std::uint32_t j) {
                ++looks;
                if (i != j && yields(queries[i], queries[j], glm::length(places[i] - places[j])))
                    answers[i] = 0;
                return answers[i] != 0;
            });
            if (!budget_.take(looks)) return false;
        }
        for (std::size_t i = 0; i < queries.size(); ++i)
            if (!queries[i].values.empty()) queries[i].values[0] = answers[i];
        return true;
    }

  private:
    bool yields(const EnvironmentQuery& own, const EnvironmentQuery& other, double distance) const {
        const double strength = value_or_0(own, 0), rival = value_or_0(other, 0);
        if (strength > rival || value_or_0(own, 1) != value_or_0(other, 1)) return false;
        const double reach = own_radii_ ? std::abs(strength) + std::abs(rival) : radius_;
        return distance <= reach;
    }

    double radius_;
    Vec3 flat_;
    bool own_radii_;
    EnvironmentBudget budget_;
};

} // namespace

std::unique_ptr<GrowthEnvironment> make_crowd(const EnvironmentSettings& settings, Diagnostics& diagnostics) {
    return std::make_unique<Competition>(settings, false, diagnostics);
}

std::unique_ptr<GrowthEnvironment> make_rivals(const EnvironmentSettings& settings,
                                               Diagnostics& diagnostics) {
    return std::make_unique<Competition>(settings, true, diagnostics);
}

} // namespace graftal
