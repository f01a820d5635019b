#pragma once

// Private to the shader: what its paths (shade.cpp) and its light (light.cpp) share.

#include <algorithm>

#include "runtime/trace/shade/shade.h"

namespace graftal {

/// POV-Ray takes smaller cosines and lights for 0 (its EPSILON).
inline constexpr double least_cosine = 1e-10;
inline constexpr double least_light = 1e-10;
/// Distance from their start within which rays meet nothing, in pixels. Where two surfaces touch, light
/// leaks through so narrow a gap.
inline constexpr double shadow_pixels = 1e-3;
/// The least roughness that is emitted (povray/emit/textures.cpp).
inline constexpr double least_roughness = 5e-4;

/// White light after its way through a surface.
inline Rgb colour_of_pane(const Material& material, Rgb rgb) {
    const double filter = material.surface_filter();
    return material.transparency * (filter * rgb + Rgb(1 - filter));
}

inline double largest(Rgb rgb) {
    return std::max({rgb.r, rgb.g, rgb.b});
}

/// A point of a surface as the viewer sees it, and what becomes of light there.
struct Shader::Point {
    Vec3 position;
    Vec3 normal; ///< towards the viewer
    Vec3 facet;  ///< normal of what mirrors and refracts
    Vec3 to_viewer;
    Rgb rgb;
    const Material* material;
    double specular, roughness, blur; ///< the material's, with what a relief too fine to be seen does
    double facing = 1;                ///< facing_of_relief() of that
    const Inside* inside;             ///< on the viewer's side
    Rgb mirrored{0.0};                ///< share of light that is
    double mirrors = 0;               ///< how much that counts
    double body = 1;                  ///< share of what scatters by the surface's colour
    Rgb through{0.0};                 ///< share that goes through
    double shone_on = 1;              ///< share of what shines on it that is left (SurfaceHit::light_share)
    Vec3 far_side{0.0};               ///< where light from behind falls on it: `position`, but of a sheet
};

} // namespace graftal
