#pragma once

#include <array>
#include <cstddef>

#include "compiler/graph/material.h"

namespace graftal {

/// The solids that a ray is in. A surface is the boundary of its material's interior: the first one on the
/// way leads in, the next one of the same interior out. What lies in another solid counts as cut out of
/// it. (POV-Ray's trace.cpp: ComputeRelativeIOR, ComputeRefraction, ComputeShadowMedia.)
class Inside {
  public:
    /// On the way in, the surface's index over that of the solid entered last. On the way out, that of the
    /// solid entered last over the surface's, even where both are one, as in POV-Ray; 1 stands for no solid.
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
