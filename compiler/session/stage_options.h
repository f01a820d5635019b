#pragma once

#include <memory>
#include <string>

#include "compiler/detail/detail_options.h"
#include "compiler/lower/lower_options.h"
#include "compiler/scene/scene.h"
#include "compiler/zoom/reroot.h"

namespace graftal {

class SharedFraming;

/// From where a model is looked at, and in how many pixels.
struct ViewOptions {
    ImageSize size;
    bool shaped = false; ///< to suit the model, of about as many pixels (shaped_size())
    CameraOverride camera;
    ZoomRequest zoom;
    /// Framing of an animation, whose frames are framed together; null: the model is framed by itself.
    std::shared_ptr<const SharedFraming> framing;
    double turn_deg = 0; ///< with a framing: how far the camera has gone round the model
    Quality quality = Quality::normal;
    DefaultLight light = DefaultLight::studio;
    bool transparent = false; ///< nothing stands behind the model (clear_background())
    bool operator==(const ViewOptions&) const = default;
};

/// The options of all stages of a session, those of each stage by themselves.
struct StageOptions {
    /// Its steps are those of the command line, for all languages. An orbit that it accepts has no graph, and
    /// ends at the stage of lowering.
    LowerOptions lower;
    std::string stop_after; ///< the last pass for models; "": all run
    ViewOptions view;
    DetailOptions detail; ///< its steps are filled in: see resolved()
    /// Whether a picture comes after the stages: they leave some of the work for it.
    bool draws = true;
};

} // namespace graftal
