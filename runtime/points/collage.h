#pragma once

#include <optional>
#include <string>

#include "compiler/session/session.h"
#include "runtime/points/target_picture.h"

namespace graftal {

struct CollageOptions {
    StageOptions compile;
    std::string target; ///< a picture
    TargetCriterion criterion;
};

/// Cover of a target set L by its images under the maps of an iterated function system (Barnsley 1985). Let
/// eps = h(L, C u union of w_j(L)) in Hausdorff distance, and s be the contractivity. Then h(L, A) <= eps /
/// (1 - s) for the attractor A. Sets are cells of a grid of pixels, which moves points by half a pixel's
/// diagonal at most; the bound has that added to eps. Lengths are in the model's units.
struct Collage {
    std::size_t target_pixels = 0;
    std::size_t pixels = 0;
    double pixel = 0;      ///< its side
    bool by_alpha = false; ///< the target is what is opaque
    std::size_t maps = 0;
    std::size_t condensations = 0;
    bool euclidean = true; ///< the norm is the plane's own
    double condition = 1;  ///< of the norm: the bound has grown by it
    double contractivity = 0;
    double epsilon = 0;
    double bound = 0;
    std::optional<double> distance; ///< measured, of target and attractor; nothing if that has too many parts
};

/// Nothing after errors in `compilation.diagnostics`, or with a failed `compilation.status`: the target
/// cannot be read.
std::optional<Collage> measure_collage(Session& session, const CollageOptions& options,
                                       Compilation& compilation);

} // namespace graftal
