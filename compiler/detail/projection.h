#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "compiler/detail/detail_options.h"
#include "compiler/detail/least_width.h"
#include "compiler/scene/scene.h"
#include "compiler/support/bounds.h"

namespace graftal {

/// Sizes of things in the picture. A *detail* is a length measured in units of the error allowed: a part
/// that measures at most 1 may be culled. Infinite where nothing is culled.
class Projection {
  public:
    /// `near` is the least distance that counts, so that the eye may lie on the model.
    Projection(const View& view, const DetailOptions& options, double error_px, double near);

    /// Pixels that one scene unit measures at the ball's nearest point, at most.
    double pixels_per_unit(const Ball& world_ball) const;
    /// pixels_per_unit(), less out of the picture, from where only shadows and reflections come.
    double pixels_that_matter(const Ball& world_ball) const;
    /// The detail of one scene unit there; less out of the picture too.
    double detail_per_unit(const Ball& world_ball) const;
    /// No ball within the region has less detail_per_unit(), nor more.
    struct DetailRange {
        double least, most;
    };
    DetailRange detail_range(const Ball& region) const;

    /// Half of what a part measures at least that has no width of its own (least_width.h), in scene units:
    /// where the error is a length, that length. 0 where nothing is culled.
    double least_half_width(const Ball& world_ball) const;
    /// No ball within the region has more.
    double most_half_width(const Ball& region) const;

    /// False if no point of the ball can be in the picture.
    bool sees(const Ball& world_ball) const;
    /// True if the ball is out of the picture, and such parts are to be left out.
    bool drops(const Ball& world_ball) const { return visible_only_ && !sees(world_ball); }

    /// Whether there may be such parts.
    bool drops_any() const { return visible_only_; }

    bool culls() const { return culls_; }
    /// Pixels of a detail of 1; 0 where the error is a length in the scene, so that a detail tells no pixels.
    double error_px() const { return error_world_ > 0 ? 0 : error_px_; }

    /// Factor on the size of culled parts that only throw shadows into the picture, or are reflected in it.
    static constexpr double coarser_out_of_sight = 8;

  private:
    Camera camera_;
    bool visible_only_;
    /// Half the angle of view, across and up; for parallel rays `sine` is half the width or height.
    struct Edge {
        double sine = 0, cosine = 1;
    };
    std::array<Edge, 2> edges_;
    int width_px_;
    double pixels_per_tangent_;
    double near_;
    double error_px_;
    double error_world_;
    bool culls_;
};

// Inlined: the tracer asks for every part that a ray goes into.

inline bool Projection::sees(const Ball& ball) const {
    const Vec3 from_eye = ball.centre - camera_.location;
    const double aside[2] = {std::abs(glm::dot(from_eye, camera_.right)),
                             std::abs(glm::dot(from_eye, camera_.up))};
    const double depth = camera_.orthographic ? 1 : glm::dot(from_eye, camera_.direction);
    for (int i = 0; i < 2; ++i)
        if (aside[i] * edges_[i].cosine - depth * edges_[i].sine > ball.radius) return false;
    return camera_.orthographic || depth >= -ball.radius;
}

inline double Projection::pixels_per_unit(const Ball& ball) const {
    if (camera_.orthographic) return width_px_ / camera_.width;
    const Vec3 from_eye = ball.centre - camera_.location;
    // Off the axis a length looks larger than its distance says, behind the eye its distance decides.
    const double depth = std::max(glm::dot(from_eye, camera_.direction), 0.5 * glm::length(from_eye));
    return pixels_per_tangent_ / std::max(depth - ball.radius, near_);
}

inline double Projection::pixels_that_matter(const Ball& ball) const {
    return pixels_per_unit(ball) / (sees(ball) ? 1 : coarser_out_of_sight);
}

inline Projection::DetailRange Projection::detail_range(const Ball& region) const {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    if (!culls_) return {infinite, infinite};
    const double hidden = sees({region.centre, -region.radius}) ? 1 : coarser_out_of_sight;
    const double hidden_all = hidden == 1 || sees(region) ? 1 : coarser_out_of_sight;
    if (error_world_ > 0) return {1 / (error_world_ * hidden), 1 / (error_world_ * hidden_all)};
    if (camera_.orthographic) {
        const double pixels = width_px_ / camera_.width;
        return {pixels / (error_px_ * hidden), pixels / (error_px_ * hidden_all)};
    }
    const Vec3 from_eye = region.centre - camera_.location;
    const double depth = std::max(glm::dot(from_eye, camera_.direction), 0.5 * glm::length(from_eye));
    return {pixels_per_tangent_ / (std::max(depth + region.radius, near_) * error_px_ * hidden),
            pixels_per_tangent_ / (std::max(depth - region.radius, near_) * error_px_ * hidden_all)};
}

inline double Projection::detail_per_unit(const Ball& ball) const {
    if (!culls_) return std::numeric_limits<double>::infinity();
    if (error_world_ > 0) return 1 / (error_world_ * (sees(ball) ? 1 : coarser_out_of_sight));
    return pixels_that_matter(ball) / error_px_;
}

inline double Projection::least_half_width(const Ball& ball) const {
    if (!culls_) return 0;
    return error_world_ > 0 ? error_world_ : std::min(least_half_width_px, error_px_) / pixels_per_unit(ball);
}

inline double Projection::most_half_width(const Ball& region) const {
    if (!culls_ || error_world_ > 0) return error_world_;
    const double px = std::min(least_half_width_px, error_px_);
    if (camera_.orthographic) return px * camera_.width / width_px_;
    const Vec3 from_eye = region.centre - camera_.location;
    const double depth = std::max(glm::dot(from_eye, camera_.direction), 0.5 * glm::length(from_eye));
    return px * std::max(depth + region.radius, near_) / pixels_per_tangent_;
}

} // namespace graftal
