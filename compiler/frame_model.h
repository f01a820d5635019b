#pragma once

#include "compiler/compile.h"

namespace graftal {

/// What is to be seen of a model: an unending one by its levels, if it has a number of them that can be
/// looked at part by part, else its limit set.
struct Sight {
    Box bounds;        ///< a stand-in where there is nothing but planes
    Outliner outliner; ///< of it, while the model lives
};

Sight sight_of(const AnalysedModel& model);

/// The view of a model as it will be drawn.
View frame_model(const AnalysedModel& model, ImageSize size, const CameraOverride& camera);

} // namespace graftal
