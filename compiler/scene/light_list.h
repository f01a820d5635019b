#pragma once

#include <vector>

#include "compiler/scene/scene.h"

namespace graftal {

/// Numbers of lights for the light of a sun's disc, of all directions, and of a lamp's area. Positive.
struct LightListSize {
    unsigned disc = 1, dome = 1, area = 1;
    bool operator==(const LightListSize&) const = default;
};

LightListSize list_size(Quality quality);

/// The lights of a view as points and parallel rays alone, the same for every engine. A sun with an angle
/// becomes suns on its disc, evenly; the sky becomes suns on a lattice of equal solid angles, those of a
/// direction d with the colour L(d) dw / pi: their sum converges to the integral that a surface takes from
/// them. Those of a picture stand for regions of much the same light (sky_cells.h). Over a ground none comes
/// from below. A lamp with an area becomes points on it, evenly. Shadowless lights and points stay as they
/// are.
std::vector<Light> listed_lights(const View& view, const LightListSize& size);

} // namespace graftal
