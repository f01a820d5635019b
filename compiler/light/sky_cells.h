#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "compiler/support/affine.h"
#include "compiler/support/tint.h"

namespace graftal {

/// The light of a sky's picture, summed up in some hundred thousand cells: enough to choose a few lights that
/// stand for it. No cell lies on both sides of the horizon.
struct SkyCells {
    struct Cell {
        glm::vec3 power{0.0f};  ///< radiance times steradians
        glm::vec3 moment{0.0f}; ///< the mean of its components times direction, summed up likewise
    };

    int columns = 0, rows = 0; ///< rows is even; the first half of them lies above the horizon
    std::vector<Cell> cells;   ///< row by row, the top first
};

/// Light from one direction in place of that of a part of the sky.
struct SkyRegion {
    Vec3 direction; ///< unit
    Rgb power;      ///< radiance times steradians, less what its spread takes from the light of a surface
};

/// At most `count` regions, and at least one for each side of the horizon that has light; fewer where the
/// light lies in fewer cells. The region whose light is spread widest is halved again and again, across its
/// longer side (Debevec, "A median cut algorithm for light probe sampling", 2005; Viriyothai and Debevec,
/// "Variance minimization light probe sampling", 2009). A surface before a whole region takes nearly as much
/// light from its one direction. Deterministic.
std::vector<SkyRegion> sky_regions(const SkyCells& cells, unsigned count, bool above_only);

} // namespace graftal
