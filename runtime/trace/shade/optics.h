#pragma once

#include <array>
#include <cstddef>

#include "compiler/graph/material.h"

namespace graftal {

/// Fresnel's reflectance for unpolarized light, as POV-Ray has it. `ior`: of what is behind the surface over
/// that of what the light is in; `cosine`: to the normal, in [0, 1]. 1 where all is reflected.
double fresnel(double ior, double cosine);

/// White light after a surface of this colour, as metallic as that: at grazing angles it stays white.
/// POV-Ray's formula, an empirical one. `cosine`: to the normal.
Rgb metal_colour(double metallic, Rgb rgb, double cosine);

/// The solids that a ray is in. A surface is the boundary of its material's interior: the first one on the
/// way leads in, the next one of the same interior out. What lies in another solid counts as cut out of
/// it. (POV-Ray's trace.cpp: ComputeRelativeIOR, ComputeRefraction, ComputeShadowMedia.)
class Inside {
  public:
    /// Index of the solid at a surface over that of the solid that the ray is in, before it crosses.
    double relative_ior(const Interior& interior) const;
    /// Crosses a surface; gives the index on this side over the one on the other. Beyond eight solids in each
    /// other it keeps to those it is in.
    double cross(const Interior& interior);
    /// The share of light left after so long a way.
    Rgb left_after(double length) const;

  private:
    const Interior* find(const Interior& interior) const;
    const Interior& last() const { return solids_[count_ - 1]; }
    void remove(const Interior* interior);

    std::array<Interior, 8> solids_; ///< the one entered last is the last
    std::size_t count_ = 0;
};

} // namespace graftal
