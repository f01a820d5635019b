#pragma once

// Private to the shader: what its paths (shade.cpp) and its light (shade_light.cpp) share.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "runtime/trace/shade.h"

namespace graftal {

/// POV-Ray takes smaller cosines and lights for 0 (its EPSILON).
inline constexpr double least_cosine = 1e-10;
inline constexpr double least_light = 1e-10;
/// How close to where they start rays meet nothing, in pixels. Where two surfaces touch, light leaks through
/// so narrow a gap.
inline constexpr double shadow_pixels = 1e-3;

/// What a surface makes of white light on its way through. An interior that absorbs has the colour in itself.
inline Rgb colour_of_pane(const Material& material, Rgb rgb) {
    return material.transparency * (material.absorption > 0 ? Rgb(1.0) : rgb);
}

inline double largest(Rgb rgb) {
    return std::max({rgb.r, rgb.g, rgb.b});
}

/// A point of a surface as the viewer sees it, and what becomes of light there.
struct Shader::Point {
    Vec3 position{0.0};
    Vec3 normal{0.0}; ///< towards the viewer
    Vec3 facet{0.0};  ///< normal of what mirrors and refracts
    Vec3 to_viewer{0.0};
    Rgb rgb{0.0};
    const Material* material = nullptr;
    const Inside* inside = nullptr; ///< on the viewer's side
    Rgb mirrored{0.0};    ///< share of light that is
    double mirrors = 0;   ///< how much that counts
    double body = 1;      ///< share of what scatters by the surface's colour
    Rgb through{0.0};     ///< share that goes through
    double shone_on = 1;  ///< share of what shines on it that is left (SurfaceHit::light_share)
};

/// A way that light may have come, seen from the camera.
struct Shader::Path {
    Ray ray;
    Rgb weight{1.0};
    double counts = 1; ///< how much it counts, for POV-Ray's bailout; no haze takes from that
    RayRange range;
    unsigned surfaces = 0, bounces = 0;
    bool takes_sky = true; ///< if it ends in the sky: else the surface that it was scattered by has its light
    Inside inside;
};

/// Light that may shine on a point: `before`, then what is left of it on its way, then `after`.
struct Shader::Shine {
    Rgb before, after;
    Ray to_light;
    RayRange range;
    std::uint32_t lamp = 0;     ///< its number; of the sky's first direction `of_sky`, then of the second
    bool is_through = false;    ///< nothing can be in its way
    bool is_shaded = false;     ///< something is, if that is known
    static constexpr std::uint32_t of_sky = UINT32_MAX - 1;

    bool is_of_sky() const { return lamp >= of_sky; }
};

/// What is known of a ray before it is followed: what it meets first, and what shines on that.
struct Shader::Ahead {
    Ray ray;
    SampleStream random{0, 0}; ///< before the ray is followed
    SurfaceHit hit;            ///< without the ground and the catcher
    bool found = false;
    Point point; ///< that, or of those: what light falls on; none in the sky
    SampleStream random_after{0, 0}; ///< once the shines are chosen
    std::vector<Shine> shines;
};

} // namespace graftal
