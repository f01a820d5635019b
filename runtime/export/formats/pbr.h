#pragma once

#include "compiler/graph/material.h"

namespace graftal {

/// A material as surfaces of metal or paint have it, by their roughness: what glTF, USD and Blender share.
struct PbrMaterial {
    double metallic = 0;
    double roughness = 1; ///< the square root of the alpha of Trowbridge and Reitz
    double emission = 0;  ///< times the colour
    double transmission = 0;
    double opacity = 1; ///< share that a veil covers; 1 for all else
    double ior = 1.5;
};

/// The nearest to graftal's, whose highlights are POV-Ray's: 1 / roughness is an exponent of Blinn's, which
/// alpha = sqrt(2 / (exponent + 2)) looks like (B. Walter et al., "Microfacet Models for Refraction", 2007).
PbrMaterial pbr_of(const Material& material);

} // namespace graftal
