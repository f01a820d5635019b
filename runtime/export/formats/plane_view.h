#pragma once

// Models in a plane, seen at right angles to it.

#include <array>
#include <optional>

#include "runtime/export/formats.h"

namespace graftal {

using Point2 = std::array<double, 2>;

/// x -> linear x + translation, in a plane.
struct Affine2 {
    std::array<double, 4> linear{1, 0, 0, 1}; ///< column by column
    Point2 translation{0, 0};

    Point2 operator()(Point2 p) const {
        return {linear[0] * p[0] + linear[2] * p[1] + translation[0],
                linear[1] * p[0] + linear[3] * p[1] + translation[1]};
    }
};
Affine2 operator*(const Affine2& a, const Affine2& b);

/// A frame as it is seen along a direction of its own: points that differ along it are one.
class SeenFrame {
  public:
    SeenFrame() = default;
    /// `along`: not zero.
    explicit SeenFrame(Vec3 along);

    Point2 operator()(Vec3 point) const { return {dot(x_, point), dot(y_, point)}; }
    Vec3 along() const { return along_; }

    /// The frame in which a part is seen that lies so in this one. Requires a map that is not singular.
    SeenFrame of_part(const Affine& frame_from_part) const;
    /// Where the part's picture lies in this one's.
    Affine2 picture_of(const SeenFrame& part, const Affine& frame_from_part) const;

    bool operator==(const SeenFrame&) const = default;

  private:
    static double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

    Vec3 along_{0, 0, 1}, x_{1, 0, 0}, y_{0, 1, 0}; ///< of unit length, at right angles
};

/// The page that a model in a plane is drawn on.
struct PlanePage {
    SeenFrame world;
    Affine2 page_from_world; ///< of pictures; y goes down
    double width = 1, height = 1;
    double scale = 1; ///< length on the page of a unit of the model
};

/// The page of the view, in pixels, or with `unit` times the lengths of the model. Nothing, after an error,
/// for a model that is in no plane.
std::optional<PlanePage> page_of(const ExportJob& job, std::optional<double> unit);

/// The outline of points, counter-clockwise, without points on its sides.
std::vector<Point2> convex_outline(std::vector<Point2> points);

} // namespace graftal
