#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compiler/scene/extremes.h"
#include "compiler/scene/scene.h"
#include "compiler/session/stage_options.h"
#include "compiler/session/values.h"

namespace graftal {

/// How all frames of an animation are framed, so that nothing moves but what is meant to: what the camera
/// setting leaves open is chosen once, so that the whole of every model that is shown is in the picture, and
/// so is the background. A plant that grows therefore grows in the picture.
class SharedFraming {
  public:
    /// One of the models that are shown to so many levels, the first frame's first.
    void include(const AnalysedModel& model, std::optional<unsigned> steps);

    /// All models are known. `camera` is the first frame's; `turning` says that it will go round.
    void settle(const CameraOverride& camera, ImageSize size, bool turning);

    /// The view of a frame whose camera has gone `turn_deg` of the options round the vertical axis through
    /// the middle of the bounds, towards its right. Multiples of 360 give equal views. Requires settle().
    View view(const AnalysedModel& model, const ViewOptions& options) const;

    bool turning() const { return turning_; }

    /// As a JSON object, from which another process reads the very same. Requires settle().
    std::string json() const;
    /// Nothing for any other text.
    static std::shared_ptr<const SharedFraming> from_json(const std::string& text);

  private:
    Camera frame(const CameraSetting& setting) const;
    CameraSetting completed(CameraSetting setting) const;

    Box bounds_;
    Extremes extremes_;
    std::vector<Vec3> outline_; ///< points whose hull holds all that will be seen
    std::vector<Rgb> colours_;  ///< that the models show
    std::optional<CameraSetting> first_setting_;
    ImageSize size_;
    bool turning_ = false;
    Camera first_;
};

} // namespace graftal
