#pragma once

#include <glm/vec2.hpp>

#include "compiler/support/affine.h"

namespace graftal {

/// Rough mirrors and rough glass: a surface of small facets whose normals are spread as Trowbridge and Reitz
/// (1975) have them (GGX; Walter et al. 2007, "Microfacet models for refraction through rough surfaces").
/// `blur` is their alpha, in (0, 1].

/// The normal of a facet, chosen by how much of it the viewer sees (Heitz 2018, "Sampling the GGX
/// distribution of visible normals"). Unit vectors; the viewer is on the normal's side. `place`: in [0, 1)^2.
Vec3 visible_facet(Vec3 normal, Vec3 to_viewer, double blur, glm::dvec2 place);

/// The share of facets that others do not hide from a direction with this cosine to the normal (Smith's G1):
/// what is left of light that a visible facet sends there. 0 below the surface.
double unhidden(double cosine, double blur);

} // namespace graftal
