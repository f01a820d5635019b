#pragma once

#include "compiler/support/control.h"
#include "runtime/plants/plant_light.h"
#include "runtime/system/interruption.h"
#include "tools/graftal/options.h"
#include "tools/graftal/progress_bar.h"

namespace graftal {

/// Options for the light on a plant's organs.
PlantLightOptions light_options(const Options& options);

/// The control that a signal ends, and whose progress the bar shows. Keeps references.
Control watched(const Interruption& interruption, ProgressBar& bar);

/// Runs `stats --plant`.
int run_plant_stats(const Options& options);

} // namespace graftal
