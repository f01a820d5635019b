#include <algorithm>
#include <unordered_map>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "compiler/environment/cell_grid.h"
#include "compiler/environment/environment.h"

// Light by shadows: Palubicki et al. 2009, "Self-organizing tree models for image synthesis", section 4.1.

namespace graftal {

namespace {

/// Each query throws a shadow upon the voxels below: q voxels down, over (2q + 1)^2 of them, of its weight
/// times a b^-q. It hears 1 less the shadow of the others.
class ShadowVoxels : public GrowthEnvironment {
  public:
    ShadowVoxels(const EnvironmentSettings& settings, Diagnostics& diagnostics)
        : size_(settings.voxel), strength_(settings.strength), decay_(settings.decay), depth_(settings.depth),
          budget_(diagnostics, settings.span) {}

    bool answer(std::span<EnvironmentQuery> queries) override {
        std::unordered_map<GridCell, double, CellHash> shadow;
        for (const EnvironmentQuery& query : queries) {
            const double weight = query.values.empty() ? 0 : query.values[0];
            if (weight != 0 && !throw_shadow(cell_of(query.place, size_), weight, shadow)) return false;
        }
        const auto at = [&](const GridCell& cell) {
            const auto known = shadow.find(cell);
            return known == shadow.end() ? 0.0 : known->second;
        };
        for (const EnvironmentQuery& query : queries) {
            if (query.values.empty()) continue;
            const GridCell cell = cell_of(query.place, size_);
            query.values[0] = std::clamp(1 - (at(cell) - strength_ * query.values[0]), 0.0, 1.0);
            if (query.values.size() < 4) continue;
            Vec3 darker(0.0);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                GridCell before = cell, after = cell;
                --before[axis];
                ++after[axis];
                darker[static_cast<int>(axis)] = at(after) - at(before);
            }
            const double slope = glm::length(darker);
            for (int axis = 0; axis < 3; ++axis)
                query.values[static_cast<std::size_t>(axis) + 1] = slope > 0 ? -darker[axis] / slope : 0;
        }
        return true;
    }

  private:
    bool throw_shadow(const GridCell& from, double weight,
                      std::unordered_map<GridCell, double, CellHash>& shadow) {
        double share = weight * strength_;
        for (std::int64_t q = 0; q <= depth_; ++q, share /= decay_) {
            if (!budget_.take(static_cast<std::uint64_t>((2 * q + 1) * (2 * q + 1)))) return false;
            for (std::int64_t i = -q; i <= q; ++i)
                for (std::int64_t k = -q; k <= q; ++k) {
                    GridCell cell = from;
                    cell[0] += k;
                    cell[1] -= q;
                    cell[2] += i;
                    shadow[cell] += share;
                }
            if (shadow.size() > max_shadow_voxels) return refuse();
        }
        return true;
    }

    bool refuse() {
        budget_.diagnostics()
            .error(budget_.span(), fmt::format("more than {} voxels lie in shadow", max_shadow_voxels))
            .with_hint("use larger voxels, or less depth");
        return false;
    }

    double size_, strength_, decay_;
    std::int64_t depth_;
    EnvironmentBudget budget_;
};

} // namespace

std::unique_ptr<GrowthEnvironment> make_shadows(const EnvironmentSettings& settings,
                                                Diagnostics& diagnostics) {
    return std::make_unique<ShadowVoxels>(settings, diagnostics);
}

} // namespace graftal
