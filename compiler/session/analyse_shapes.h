#pragma once

#include <vector>

#include "compiler/analysis/bounding.h"
#include "compiler/analysis/contraction.h"
#include "compiler/graph/components.h"
#include "compiler/graph/graph.h"
#include "compiler/session/values.h"
#include "compiler/support/control.h"

namespace graftal {

/// Decides the contraction of a model, and bounds it where it converges. Where there is too much for the
/// effort of bounding, objects that differ in their colours only are looked at once. `times` gets both
/// stages.
void analyse_shapes(AnalysedModel& model, std::vector<StageTime>& times, const Control& control);

/// Whether the limit of the unfolding is known to exist.
bool converges(const Contraction& contraction);

} // namespace graftal
