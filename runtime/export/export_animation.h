#pragma once

#include "runtime/export/export_model.h"
#include "runtime/render/animate.h"

namespace graftal {

/// Writes a model that changes as USD: NAME.usda, the `output` of `animate`, shows one state of the model in
/// each frame. The states are files of their own in the folder NAME.frames, each once for neighbouring frames
/// that are equal; camera and lights are those of the last. NAME.usda appears at last, and only if all states
/// are there. `exported`: of each state, except its moving values and its output. Cancelled as export_model()
/// is.
AnimationOutcome export_animation(PictureSession& session, const AnimateOptions& animate,
                                  const ExportModelOptions& exported);

} // namespace graftal
