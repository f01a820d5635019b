#pragma once

#include "compiler/compile.h"

namespace graftal {

/// The view of a model as it will be drawn: an unending one by its levels, if it has a number of them that
/// can be looked at part by part, else by its limit set.
View frame_model(const AnalysedModel& model, ImageSize size, const CameraOverride& camera);

} // namespace graftal
