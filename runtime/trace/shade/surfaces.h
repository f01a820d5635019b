#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "compiler/graph/settings.h"
#include "compiler/support/ray.h"
#include "compiler/support/tint.h"

namespace graftal {

/// Where a ray meets a surface.
struct SurfaceHit {
    double t = 0;
    Vec3 normal{0, 1, 0};               ///< of unit length, to either side
    Rgb rgb{0.8};                       ///< opaque, all tints in front
    const Material* material = nullptr; ///< its finish; its rgb does not count
    double light_share = 1;             ///< share of the light on it, less its own shade (self_shadow.h)
    double faded = 0; ///< mean square slope, along one axis, of a relief too fine to be seen (patterns.h)
    /// The way through a solid as thin as a sheet, to its far side: light that comes through goes on there. 0
    /// of other surfaces, and of what is not translucent.
    Vec3 to_far_side{0.0};
    /// Number in the prepared graph of the last node on the way from the root that is no primitive.
    std::uint32_t node = no_node;
    std::uint32_t levels = 0;   ///< levels that the way has used up (graph.h, "Levels")
    std::uint32_t instance = 0; ///< the id of the way (mattes.h), where it is asked for

    static constexpr std::uint32_t no_node = UINT32_MAX;
};

/// Surfaces that rays can meet, in world space. One for each thread: looking may use its memory.
class Surfaces {
  public:
    virtual ~Surfaces() = default;

    /// The first surface within the range, if there is one.
    virtual bool closest(const Ray& ray, const RayRange& range, SurfaceHit& hit) = 0;
    /// The first surfaces of several rays, at most most_together: one bit for each that meets something.
    /// Faster than one by one where neighbours of a picture are asked for together.
    virtual std::uint32_t closest_each(std::span<const Ray> rays, const RayRange& range,
                                       std::span<SurfaceHit> hits) {
        std::uint32_t met = 0;
        for (std::size_t i = 0; i < rays.size(); ++i)
            met |= static_cast<std::uint32_t>(closest(rays[i], range, hits[i])) << i;
        return met;
    }
    static constexpr std::size_t most_together = 8;
    /// Whether there is any surface within the range.
    virtual bool meets_any(const Ray& ray, const RayRange& range) = 0;
    /// Whether no surface at all lets light through: what looks no further is faster.
    virtual bool all_opaque() const { return false; }
};

} // namespace graftal
