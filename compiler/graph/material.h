#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "compiler/graph/pattern.h"
#include "compiler/support/affine.h"
#include "compiler/support/number_range.h"
#include "compiler/support/source.h"
#include "compiler/support/tint.h"

namespace graftal {

using MaterialId = std::uint32_t;

/// The finish of a surface; the numbers are those of POV-Ray, which the tracer follows too
/// (trace/shade/optics.h).
struct Material {
    std::string name;
    Rgb rgb{0.8};
    double ambient = 0.1;
    double diffuse = 0.8;
    double specular = 0.1;
    double roughness = 0.05;
    double reflection = 0;
    double translucency = 0; ///< diffuse light that comes through, from behind: of leaves and paper
    double emission = 0;     ///< light of its own
    double metallic = 0;     ///< how much of its colour highlights and reflections take on
    double transparency = 0; ///< the share of light that goes straight in, and out again
    double filter = 1;       ///< how much of its colour that takes on; 0: none, as behind a veil
    double ior = 1;          ///< index of refraction; above 1, the surface reflects by Fresnel's formula
    /// The path in scene units that leaves of white light the material's own rgb; 0: it is the surface that
    /// colours what goes through it.
    double absorption = 0;
    double blur =
        0; ///< how rough mirrors and glass are: the alpha of Trowbridge and Reitz (trace/shade/formulas.glsl)
    /// The picture that is wrapped round each primitive in place of rgb (texture_space.h). It is named by
    /// the file it is read from or the model it is drawn from; empty: none. Where its alpha is below 1/2
    /// there is no surface.
    std::string texture;
    double around = 1;    ///< how often it goes round what is round
    double coverage = 1;  ///< share of the picture that is not clear
    SolidPattern pattern; ///< not of one with a picture
    Span span;

    /// Spans do not count.
    bool operator==(const Material& other) const;

    /// Whether its colour depends on the place on the surface.
    bool is_painted() const { return !texture.empty() || pattern; }
    bool is_transparent() const { return transparency > 0; }
    /// The share of its colour that the surface gives to light on its way through; 0 where the inside
    /// absorbs.
    double surface_filter() const { return absorption > 0 ? 0 : filter; }
    /// Whether it covers what is behind it by a share, and does nothing else to it.
    bool is_veil() const { return is_transparent() && filter == 0 && !has_coat(); }
    /// Surfaces that a ray meets at most, one behind the other; and where some are veils, which lie in
    /// stacks: as many as POV-Ray follows.
    static constexpr unsigned most_surfaces = 32, most_veils = 256;
    /// Whether what it mirrors, or shows behind itself, is blurred.
    bool is_blurred() const { return blur > 0 && (reflection > 0 || is_transparent()); }
    /// Whether it has a clear coat, which reflects more the more a ray grazes it. Light that the coat
    /// reflects does not reach what is below it.
    bool has_coat() const { return ior > 1; }
};

/// One number of a surface's finish: a row of the table that texts, checks and comparisons read.
struct FinishNumber {
    std::string_view name; ///< in models
    double Material::*value;
    double most = 1;
    double least = 0;
    bool positive = false; ///< and not 0
    bool always = true;    ///< `print` writes it, also where it is as it would be anyhow
};

inline constexpr FinishNumber finish_numbers[] = {
    {"ambient", &Material::ambient},
    {"diffuse", &Material::diffuse},
    {"specular", &Material::specular},
    {.name = "roughness", .value = &Material::roughness, .positive = true},
    {"reflection", &Material::reflection},
    {.name = "translucency", .value = &Material::translucency, .always = false},
    {.name = "emission", .value = &Material::emission, .most = 1e6, .always = false},
    {.name = "metallic", .value = &Material::metallic, .always = false},
    {.name = "transparency", .value = &Material::transparency, .always = false},
    {.name = "filter", .value = &Material::filter, .always = false},
    {.name = "ior", .value = &Material::ior, .most = 10, .least = 1, .always = false},
    {.name = "absorption", .value = &Material::absorption, .most = largest_size, .always = false},
    {.name = "blur", .value = &Material::blur, .always = false},
};

/// Whether the finishes are equal, whatever the colours.
bool same_finish(const Material& a, const Material& b);

/// The medium that light meets within a solid.
struct Interior {
    double ior = 1;
    Rgb absorbed{0.0}; ///< optical depth of a unit of length
    bool operator==(const Interior&) const = default;
};

/// The medium between surfaces of this material. POV-Ray counts only rays that bend: none goes straight on.
Interior interior_of(const Material& material);

} // namespace graftal
