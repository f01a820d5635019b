#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "compiler/support/affine.h"
#include "compiler/support/diagnostics.h"

// The surroundings of a growing model, which answer its queries after each step: Mech and Prusinkiewicz
// 1996, "Visual models of plants interacting with their environment" (docs/language.md, "The environment").

namespace graftal {

/// A query of a turtle. Its values are what it tells, and become what it hears.
struct EnvironmentQuery {
    Vec3 place{0.0};
    std::span<double> values;
};

/// Regions of space; the allowed space is their union.
struct EnvironmentRegion {
    enum class Kind : std::uint8_t { sphere, box, half_space } kind = Kind::sphere;
    Vec3 a{0.0};       ///< centre, least corner, or unit normal
    Vec3 b{0.0};       ///< greatest corner
    double extent = 0; ///< radius; of the half-space {p: a.p <= extent}

    /// The distance of the place from the surface; negative inside.
    double distance(Vec3 place) const;
};

/// Light from infinitely far, out of this direction, a unit vector.
struct EnvironmentSource {
    Vec3 direction{0.0};
    double intensity = 0;
};

struct EnvironmentSettings {
    enum class Kind : std::uint8_t {
        regions, ///< distance from the allowed space
        crowd,   ///< whether a query is the only one, or the strongest, within a radius
        rivals,  ///< whether a disc overlaps no larger one
        shade,   ///< light that balls about all queries let through
        shadows, ///< light by shadows in voxels
        points,  ///< points of free space that attract (space colonisation)
    };
    Kind kind = Kind::regions;
    std::vector<EnvironmentRegion> regions; ///< also of `points`
    double radius = 0;                      ///< of a crowd; positive
    Vec3 flat{0.0}; ///< unit vector that distances of a crowd or of rivals take no notice of; 0: none
    double transmittance = 0;               ///< of a ball, in [0, 1]
    std::vector<EnvironmentSource> sources; ///< intensities sum to 1; none: a uniform sky
    double voxel = 1, strength = 1, decay = 2;
    unsigned depth = 0; ///< in voxels
    std::uint32_t point_count = 0;
    double influence = 0, kill = 0; ///< distances of points
    std::uint64_t seed = 0;
    Span span; ///< of the statement
};

/// All that is looked at in one model; more is an error.
inline constexpr std::uint64_t max_environment_work = 500'000'000;
/// Voxels that lie in shadow after one step; more are an error.
inline constexpr std::size_t max_shadow_voxels = 20'000'000;
/// Points of one model.
inline constexpr std::uint32_t max_attraction_points = 1'000'000;

class GrowthEnvironment {
  public:
    virtual ~GrowthEnvironment() = default;

    /// Puts the answers in place of the values; a query with fewer values hears as much as it has room for.
    /// Nothing of chance beyond the seed, nothing of the order of the queries. False after an error.
    virtual bool answer(std::span<EnvironmentQuery> queries) = 0;
};

/// `diagnostics` must outlive it. Null after an error.
std::unique_ptr<GrowthEnvironment> make_environment(const EnvironmentSettings& settings,
                                                    Diagnostics& diagnostics);

/// Counts what is looked at.
class EnvironmentBudget {
  public:
    EnvironmentBudget(Diagnostics& diagnostics, Span span) : diagnostics_(diagnostics), span_(span) {}

    /// False after the error that there is too much, which is said once.
    bool take(std::uint64_t work);
    Diagnostics& diagnostics() { return diagnostics_; }
    Span span() const { return span_; }

  private:
    Diagnostics& diagnostics_;
    Span span_;
    std::uint64_t left_ = max_environment_work;
    bool said_ = false;
};

// One for each kind; see EnvironmentSettings::Kind.
std::unique_ptr<GrowthEnvironment> make_regions(const EnvironmentSettings& settings);
std::unique_ptr<GrowthEnvironment> make_crowd(const EnvironmentSettings& settings, Diagnostics& diagnostics);
std::unique_ptr<GrowthEnvironment> make_rivals(const EnvironmentSettings& settings, Diagnostics& diagnostics);
std::unique_ptr<GrowthEnvironment> make_shade(const EnvironmentSettings& settings, Diagnostics& diagnostics);
std::unique_ptr<GrowthEnvironment> make_shadows(const EnvironmentSettings& settings,
                                                Diagnostics& diagnostics);
/// Null after an error.
std::unique_ptr<GrowthEnvironment> make_points(const EnvironmentSettings& settings, Diagnostics& diagnostics);

} // namespace graftal
