#pragma once

#include <optional>

#include "compiler/scene/scene.h"
#include "runtime/image/image.h"
#include "runtime/points/accumulation.h"
#include "runtime/points/colour_scale.h"

namespace graftal {

/// The source of the points' colours.
enum class PointColour {
    tint,    ///< composed of the graph's tints on their way
    map,     ///< one for each map, by the one that was applied last
    density, ///< by how many there are
};

/// The way from numbers of points to a picture. Let a pixel have n points. Let m be the mean over all pixels
/// that have any, and w the number that 95 of 100 of these do not exceed. The points have the weight
///     a = (log(1 + exposure n / m) / log(1 + exposure w / m))^(1 / gamma)
/// and their mean colour.
struct Tone {
    double exposure = 30;
    double gamma = 1;
    bool transparent = false; ///< no ground, but an alpha
    bool by_density = false;  ///< colours of the scale by a, instead of the points' own
    bool light = false; ///< they add a times their colour to the ground; else they cover a of it, at most all
    double glow = 0;    ///< the share of their light that spreads around them, in [0, 1]
    std::optional<Rgb> ground; ///< in linear light; nothing: the model's background
    ColourScale scale;
};

/// The picture in linear light, RGB, or with straight alpha. An accumulation without points gives the
/// ground. Requires that light is not transparent.
Image toned(const Accumulation& points, const Tone& tone, const View& view);

/// A colour for the map of this number: neighbours differ.
Rgb map_colour(std::uint32_t number);

} // namespace graftal
