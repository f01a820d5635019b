#pragma once

#include "runtime/gpu/flat_model.h"

namespace graftal {

/// Adds materials, lights, sky, air and camera to a flat model, the plane of a set that lies in one, and the
/// table of the pixel filter.
void add_light(const FlatRequest& request, const TraceBasis& basis, FlatModel& flat);

} // namespace graftal
