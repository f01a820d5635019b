#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "runtime/studio/part_ray.h"
#include "runtime/studio/studio_home.h"
#include "runtime/studio/studio_state.h"

namespace graftal {

/// Answers what the pointer asks of the picture: which part is under a pixel, and which view lies nearer to
/// it. It looks at the model as the text names it, before passes merge what is equal.
class Pointer {
  public:
    /// `files`: those of the home, with the ones of links over them. `cancel` ends its stages.
    Pointer(StudioHome& home, const Files& files, CancelFlag cancel)
        : home_(home), files_(files), cancel_(std::move(cancel)) {}

    /// The state that it is asked about. Requires a text.
    void look_at(const StudioState& state) { state_ = state; }

    /// Files that the model names are read again.
    void forget_files() { session_.reset(); }

    /// The answer to `pick`; an empty object for the background. Throws BadMessage.
    nlohmann::json pick(double x, double y);

    /// The point under the pixel (x, y) comes to another one, and is enlarged.
    struct Grip {
        double x = 0, y = 0;
        double dx = 0, dy = 0;
        double factor = 1;
    };

    /// The answer to `zoom`: a view in which the grip has done so. A step back from the pixel where it ended
    /// leads to the very view that the step came from. Near the whole, the camera moves; beyond, the graph
    /// gets a new root, so that no depth is the last. Requires a positive factor. Throws BadMessage.
    nlohmann::json zoom(const Grip& grip);

  private:
    /// A view of a state.
    struct Place {
        std::string at, zoom;
        std::optional<nlohmann::json> camera; ///< nothing: the model's
        CameraOverride override;
        bool operator==(const Place& other) const {
            return at == other.at && zoom == other.zoom && override == other.override;
        }
    };
    struct Step {
        Place from, to;
        Grip grip;
    };

    /// Null, with the reason in `problem`.
    std::shared_ptr<const ViewedModel> view(const StageOptions& stages, std::string& problem);
    std::shared_ptr<const ViewedModel> needed_view();
    std::optional<MetPart> part_near(const ViewedModel& viewed, double x, double y) const;
    /// The path in the model's graph: under a zoom the root is another.
    std::vector<GraphStep> whole_path(const ViewedModel& viewed, const std::vector<GraphStep>& path) const;
    Place current() const;
    static Place placed(std::string at, std::string zoom, nlohmann::json camera);
    static Camera dollied(const Camera& camera, Vec3 point, double factor);
    Place nearer(const ViewedModel& viewed, const Grip& grip);
    Vec3 focus_in_world(const AnalysedModel& whole) const;
    Place rooted(const ViewedModel& viewed, const std::optional<MetPart>& met, Camera camera, double distance,
                 const Magnification& zoom, double scale);

    StudioHome& home_;
    const Files& files_;
    CancelFlag cancel_;
    StudioState state_;
    std::unique_ptr<Session> session_; ///< of the names
    std::string session_name_, session_text_;
    Compilation compilation_;
    std::deque<Step> steps_;
};

} // namespace graftal
