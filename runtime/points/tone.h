#pragma once

#include "compiler/scene/scene.h"
#include "runtime/image/image.h"
#include "runtime/points/accumulation.h"

namespace graftal {

/// What colour points have.
enum class PointColour {
    tint,    ///< as the graph composes the tints on their way
    map,     ///< one for each map, by the one that was applied last
    density, ///< by how many there are
};

/// How numbers of points become a picture. With n points in a pixel, m in the mean over all pixels that have
/// any, and w the number that 95 of 100 of these do not exceed, the points cover
///     a = (log(1 + exposure n / m) / log(1 + exposure w / m))^(1 / gamma)
/// of the pixel, at most all of it, with their mean colour.
struct Tone {
    double exposure = 30;
    double gamma = 1;
    bool transparent = false; ///< no background, but an alpha
    bool by_density = false;  ///< colours by a instead of the points' own
};

/// The picture in linear light, RGB, or with straight alpha. An accumulation without points gives the
/// background.
Image toned(const Accumulation& points, const Tone& tone, const View& view);

/// A colour of the scale that densities are shown by, 0 <= x <= 1, from dark to bright.
Rgb density_colour(double x);

/// A colour for the map of this number: neighbours differ.
Rgb map_colour(std::uint32_t number);

} // namespace graftal
