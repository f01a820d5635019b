#pragma once

#include "compiler/graph/pattern.h"
#include "runtime/trace/shade/surfaces.h"

namespace graftal {

/// A solid pattern at a place.
struct PatternValue {
    double value = 0.5; ///< in (0, 1)
    /// Gradient of the relief of bump 1, in lengths per length.
    Vec3 relief{0.0};
    /// Mean square along one axis of the relief that is finer than the footprint, and not in `relief`.
    double faded = 0;
};

/// `size`: pattern_size() of the part. `footprint`: the length in the world that a sample stands for there.
/// Requires a pattern with layers.
PatternValue pattern_at(const SolidPattern& pattern, double size, double footprint, Vec3 world);

/// pattern_normal() of patterns.glsl where the relief is `bump` times as deep.
Vec3 bumped(Vec3 normal, Vec3 relief, double bump, Vec3 ray_direction);

/// Gives a hit the relief of a pattern there, `bump` times as deep. `ray_direction`: of unit length.
void show_relief(const PatternValue& at, double bump, Vec3 ray_direction, SurfaceHit& hit);

} // namespace graftal
