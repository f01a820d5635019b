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

/// One framing of all frames of an animation, so that only what is meant to move moves. Values that the
/// camera setting leaves open are chosen once, and so is the background: the whole of every model that is
/// shown is in the picture. A plant that grows therefore grows in the picture.
class SharedFraming {
  public:
    /// Takes one of the models that are shown, each to its `steps` levels, the first frame's first.
    void include(const AnalysedModel& model, std::optional<unsigned> steps);

    /// All models are known. `camera` is the first frame's; `turning` says that it will go round.
    void settle(const CameraOverride& camera, ImageSize size, bool turning);
    ImageSize size() const { return size_; }

    /// The view of a frame. Its camera has gone `turn_deg` of the options round the vertical axis through
    /// the middle of the bounds, towards its right. Multiples of 360 give equal views. Requires settle().
    View view(const AnalysedModel& model, const ViewOptions& options) const;

    bool turning() const { return turning_; }

    /// The framing as a JSON object, from which another process reads the very same. Requires settle().
    std::string json() const;
    /// Nothing for any other text.
    static std::shared_ptr<const SharedFraming> from_json(const std::string& text);

  private:
    Camera frame(const CameraSetting& setting) const;
    CameraSetting completed(CameraSetting setting) const;

    Box bounds_;
    Extremes extremes_;
    std::vector<Vec3> outline_; ///< points whose hull holds all that will be seen
    std::vector<Rgb> colours_;  ///< colours in the models
    std::optional<CameraSetting> first_setting_;
    ImageSize size_;
    bool turning_ = false;
    Camera first_;
};

} // namespace graftal
