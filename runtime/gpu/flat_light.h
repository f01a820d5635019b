#pragma once

#include "runtime/gpu/flat_model.h"

namespace graftal {

/// Adds materials, lights, sky, air and camera to a flat model, and the table of the pixel filter.
void add_light(const FlatRequest& request, FlatModel& flat);

} // namespace graftal
