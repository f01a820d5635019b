#include "compiler/session/shared_framing.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "compiler/scene/backdrop.h"
#include "compiler/scene/framing.h"
#include "compiler/session/frame_model.h"

namespace graftal {

namespace {

/// More models add nothing to the choice between a light and a dark background.
constexpr std::size_t most_colours = 100'000;

/// To the corners, edges and faces of a cube: where the view comes from is not known yet.
std::vector<Vec3> directions_all_round() {
    std::vector<Vec3> directions;
    for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z)
                if (x != 0 || y != 0 || z != 0) directions.push_back(glm::normalize(Vec3(x, y, z)));
    return directions;
}

/// About the vertical axis, from z towards x.
class Turn {
  public:
    explicit Turn(double degrees) {
        const double rest = std::fmod(degrees, 360.0) * std::numbers::pi / 180;
        sine_ = std::sin(rest);
        cosine_ = std::cos(rest);
    }
    Vec3 operator()(Vec3 v) const { return {cosine_ * v.x + sine_ * v.z, v.y, cosine_ * v.z - sine_ * v.x}; }

  private:
    double sine_, cosine_;
};

} // namespace

void SharedFraming::include(const AnalysedModel& model, std::optional<unsigned> steps) {
    if (!first_setting_) first_setting_ = model.graph.settings.camera.value_or(CameraSetting{});
    if (colours_.size() < most_colours) {
        const std::vector<Rgb> colours = sample_colours(model.graph);
        colours_.insert(colours_.end(), colours.begin(), colours.end());
    }
    if (model.bounds[model.graph.root].box.empty()) return; // its stand-in would count
    const Sight sight = sight_of(model, steps);
    bounds_.include(sight.bounds);
    extremes_.include(sight.outliner(directions_all_round()));
}

void SharedFraming::settle(const CameraOverride& camera, ImageSize size, bool turning) {
    if (bounds_.empty()) bounds_ = {Vec3(-1.0), Vec3(1.0)};
    size_ = size;
    turning_ = turning;
    outline_ = extremes_.points();
    if (turning) outline_ = revolved(outline_, bounds_.centre());
    first_ = frame(merge(*first_setting_, camera));
}

View SharedFraming::view(const AnalysedModel& model, const ViewOptions& options) const {
    const CameraSetting setting =
        merge(model.graph.settings.camera.value_or(CameraSetting{}), options.camera);
    Camera turned = frame(completed(setting));
    const Turn turn(options.turn_deg);
    turned.location = bounds_.centre() + turn(turned.location - bounds_.centre());
    turned.direction = turn(turned.direction);
    turned.up = turn(turned.up);
    turned.right = turn(turned.right);
    return view_through(turned, setting, model.graph, bounds_, size_, colours_, options.light,
                        model.clouds.get());
}

Camera SharedFraming::frame(const CameraSetting& setting) const {
    return frame_camera(
        setting, bounds_, [this](const auto&) { return outline_; }, size_, turning_);
}

/// Fills in what the setting leaves open as in the first frame.
CameraSetting SharedFraming::completed(CameraSetting setting) const {
    if (!setting.location) {
        setting.location = first_.location;
        const double distance = glm::length(bounds_.centre() - first_.location);
        if (!setting.look_at) setting.look_at = first_.location + distance * first_.direction;
    }
    if (setting.angle_deg || setting.width) return setting;
    if (first_.orthographic) {
        setting.orthographic = true;
        setting.width = first_.width;
    } else {
        setting.angle_deg = first_.angle_deg;
    }
    return setting;
}

} // namespace graftal
