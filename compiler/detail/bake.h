#pragma once

#include "compiler/detail/baked.h"
#include "compiler/detail/graph/symmetry.h"

namespace graftal {

/// Tints in front of pictures are told apart no better than this: each is a texture of its own.
inline constexpr double texture_tint_grain = 1.0 / 64;
PathTint rounded(const PathTint& tint, double grain);

/// Unfolds the request into triangles. Leaves that coincide are drawn once; faces on which two cubes meet are
/// not drawn at all, nobody can see them. Deterministic.
Baked bake(const DetailGraph& cut, const Symmetry& symmetry, const BakeRequest& request,
           std::size_t max_triangles);

} // namespace graftal
