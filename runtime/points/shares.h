#pragma once

#include <vector>

#include "compiler/scene/scene.h"
#include "compiler/session/values.h"
#include "compiler/support/diagnostics.h"

namespace graftal {

/// The sizes of the root's instances in a picture: of their parts that are in the picture, the areas, over
/// the squares of their distances from the eye. Hills on the horizon have the area of many trees, and show
/// less. Empty if chances are stated there, or it is part of a recursion. Some 100,000 parts are looked at,
/// the largest first, and the others by the wholes that they lie in.
std::vector<double> shown_sizes(const AnalysedModel& model, const View& view);

/// Warns of the root's named parts that get next to none of the points. `shares`: of its instances; empty: by
/// chances_of().
void warn_of_missed_parts(const AnalysedModel& model, std::vector<double> shares, Diagnostics& diagnostics);

} // namespace graftal
