#include "compiler/scene/framing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace graftal {

namespace {

/// Share of the picture's width or height, on each side. With exactly a twentieth, rows of pixels would run
/// along the edges of figures at halves and quarters. There rounding decides what a ray meets, in each
/// engine by itself.
constexpr double margin = 0.05 + 0x1p-32;
constexpr double automatic_angle_deg = 36; // across the longer side of the picture
constexpr double widest_angle_deg = 90;    // limit for fitting
constexpr double close_up_angle_deg = 60;  // where the eye is too near to fit
constexpr double azimuth_deg = 28;         // of the eye, from the front towards the right
constexpr double elevation_deg = 20;       // of the eye
constexpr double slab_elevation_deg = 42;  // of the eye over a model that lies on the ground
constexpr double solid_share = 0.35;       // thickness from which on a model is seen fully from the side
constexpr double place_grain = 0x1p-38;    // of the model's size: bounds are known to about 1e-12 of it

double radians(double degrees) {
    return degrees * std::numbers::pi / 180;
}

/// Bounds as the camera sees them: centred, of half extent 1, so that no length can over- or underflow.
struct Subject {
    Vec3 centre;
    double scale = 1;          ///< scene units
    std::vector<Vec3> corners; ///< their hull holds all that is to be seen

    explicit Subject(const Box& bounds) : centre(0.5 * bounds.min + 0.5 * bounds.max) {
        const Vec3 half = 0.5 * bounds.max - 0.5 * bounds.min;
        scale = std::max({half.x, half.y, half.z, 1e-12 * largest_entry(centre)});
        if (scale == 0) scale = 1; // a point at the origin
        for (const Vec3& corner : Box{-half, half}.corners())
            corners.push_back(corner / scale);
    }

    Vec3 local(Vec3 world) const { return (world - centre) / scale; }
    Vec3 world(Vec3 local) const { return centre + scale * local; }
};

/// A place without the digits that bounds do not give. A symmetric model is seen from its very middle, and
/// from one place by both engines: POV-Ray reads 12 digits. So rays along edges meet them in both.
Vec3 without_noise(Vec3 place, const Subject& subject) {
    const double grain = place_grain * std::exp2(std::ceil(std::log2(subject.scale)));
    for (int axis = 0; axis < 3; ++axis) {
        const double steps = place[axis] / grain;
        if (std::abs(steps) < 0x1p52) place[axis] = std::round(steps) * grain;
    }
    return place;
}

Vec3 axis_vector(int axis) {
    Vec3 v(0.0);
    v[axis] = 1;
    return v;
}

Vec3 eye_direction(double azimuth, double elevation) {
    const double a = radians(azimuth), e = radians(elevation);
    return {std::sin(a) * std::cos(e), std::sin(e), std::cos(a) * std::cos(e)};
}

/// From the model towards the eye, where nothing says otherwise.
Vec3 automatic_eye_direction(const Box& bounds) {
    const double share = thickness(bounds);
    const int axis = thinnest_axis(bounds);
    if (share <= flat_share) return axis_vector(axis);
    const double t = std::clamp((share - thin_share) / (solid_share - thin_share), 0.0, 1.0);
    const double solid = t * t * (3 - 2 * t);
    if (axis == 1)
        return eye_direction(azimuth_deg, slab_elevation_deg + solid * (elevation_deg - slab_elevation_deg));
    if (share <= thin_share) return axis_vector(axis);
    const Vec3 aside = eye_direction(azimuth_deg, elevation_deg);
    return glm::normalize(solid * aside + (1 - solid) * axis_vector(axis));
}

/// Sets up and right to go with the direction. An up vector along the direction says nothing: then the y
/// axis stands in, and where that is the line of sight itself, the z axis, away from the eye's side.
void orient(Camera& camera, Vec3 direction, Vec3 up) {
    camera.direction = direction;
    const auto aside = [&](Vec3 v) { return glm::cross(direction, v); };
    const auto useless = [&](Vec3 v) {
        const double length = glm::length(v);
        return !(length > 0) || !std::isfinite(length) || glm::length(aside(v)) <= 1e-9 * length;
    };
    if (useless(up)) up = {0, 1, 0};
    if (useless(up)) up = {0, 0, direction.y < 0 ? -1 : 1};
    camera.right = glm::normalize(aside(up));
    camera.up = glm::cross(camera.right, direction);
}

/// Half extents of the picture per unit of depth, less the margin.
struct Frustum {
    double x, y;

    Frustum(double angle_deg, double aspect)
        : x((1 - 2 * margin) * std::tan(radians(angle_deg) / 2)), y(x / aspect) {}
};

/// A point in the camera's axes: to the right, up, and depth.
Vec3 in_axes(const Camera& camera, Vec3 p) {
    return {glm::dot(p, camera.right), glm::dot(p, camera.up), glm::dot(p, camera.direction)};
}

/// The box of all corners, in the camera's axes.
Box in_axes(const Camera& camera, const Subject& subject) {
    Box box;
    for (const Vec3& corner : subject.corners)
        box.include(in_axes(camera, corner));
    return box;
}

/// Moves the eye across until the margins left and right, and below and above, are equal. The tighter pair is
/// so already.
class EyeCentring {
  public:
    EyeCentring(const Camera& camera, const Subject& subject) : camera_(camera), subject_(subject) {}

    void run(Vec3& eye) {
        const Vec3 start = eye;
        const double depth = in_axes(camera_, Vec3(0.0)).z - eye.z;
        Vec3 step(0.0);
        for (int i = 0; i < 20; ++i) {
            step = 0.5 * depth * imbalance(eye);
            eye.x += step.x;
            eye.y += step.y;
        }
        constexpr double centred = 1e-6;
        if (std::max(std::abs(step.x), std::abs(step.y)) <= centred) return;
        eye = start;
        halve(eye);
    }

  private:
    static constexpr double farthest_moved = 1.0 / 64;

    /// Where corners stand much nearer than the middle, the steps above are too long, and lead away.
    void halve(Vec3& eye) {
        auto [low, high] = in_axes(camera_, subject_);
        for (int i = 0; i < 50; ++i) {
            const Vec3 off = imbalance(eye); // falls as the eye moves on
            for (int axis = 0; axis < 2; ++axis) {
                (off[axis] > 0 ? low : high)[axis] = eye[axis];
                eye[axis] = 0.5 * (low[axis] + high[axis]);
            }
        }
    }

    /// The slopes of the outermost rays on both sides, added up: 0 where the eye is in the middle.
    Vec3 imbalance(Vec3 eye) {
        const Vec3 moved = glm::abs(eye - looked_from_);
        if (outermost_.empty() || std::max(moved.x, moved.y) > 0.9 * farthest_moved) look_from(eye);
        Box slopes;
        for (const Vec3& corner : outermost_)
            slopes.include((corner - eye) / (corner - eye).z);
        return slopes.max + slopes.min;
    }

    /// Finds the few corners that can be outermost while the eye stays near. Only these are looked at again.
    void look_from(Vec3 eye) {
        looked_from_ = eye;
        outermost_.clear();
        const Vec3 slack(farthest_moved, farthest_moved, 0);
        Vec3 most(-std::numeric_limits<double>::infinity()), least(-most);
        for (const Vec3& corner : subject_.corners) {
            const Vec3 p = in_axes(camera_, corner) - eye;
            most = glm::max(most, (p - slack) / p.z);
            least = glm::min(least, (p + slack) / p.z);
        }
        for (const Vec3& corner : subject_.corners) {
            const Vec3 place = in_axes(camera_, corner), p = place - eye;
            const Vec3 greatest = (p + slack) / p.z, smallest = (p - slack) / p.z;
            if (greatest.x >= most.x || greatest.y >= most.y || smallest.x <= least.x ||
                smallest.y <= least.y)
                outermost_.push_back(place);
        }
    }

    const Camera& camera_;
    const Subject& subject_;
    Vec3 looked_from_{0.0};
    std::vector<Vec3> outermost_; ///< in the camera's axes
};

/// The nearest eye whose frustum holds all corners, in the camera's axes. Each side plane of the frustum asks
/// for slope * depth_of_eye <= c: the two that are tighter meet in the answer.
Vec3 nearest_eye(const Camera& camera, const Subject& subject, Frustum slope) {
    double depth = std::numeric_limits<double>::infinity();
    Vec3 most(-depth), least(-depth);
    for (const Vec3 corner : subject.corners) {
        const Vec3 p = in_axes(camera, corner);
        most = glm::max(most, Vec3(p.x - slope.x * p.z, p.y - slope.y * p.z, 0));
        least = glm::max(least, Vec3(-p.x - slope.x * p.z, -p.y - slope.y * p.z, 0));
        depth = std::min(depth, p.z - 0.25); // never in the model
    }
    depth = std::min({depth, -(most.x + least.x) / (2 * slope.x), -(most.y + least.y) / (2 * slope.y)});
    Vec3 eye((most.x - least.x) / 2, (most.y - least.y) / 2, depth);
    EyeCentring(camera, subject).run(eye);
    return eye;
}

/// Least distance of the eye from `target` (local), which stays in the middle of the picture.
double nearest_distance(const Camera& camera, const Subject& subject, Vec3 target, Frustum slope) {
    double distance = 0;
    for (const Vec3 corner : subject.corners) {
        const Vec3 p = in_axes(camera, corner - target);
        distance =
            std::max({distance, std::abs(p.x) / slope.x - p.z, std::abs(p.y) / slope.y - p.z, 0.25 - p.z});
    }
    return distance;
}

/// The horizontal angle that shows all corners from a given eye (local).
double fitting_angle_deg(const Camera& camera, const Subject& subject, Vec3 eye, double aspect) {
    double tangent = 0;
    for (const Vec3 corner : subject.corners) {
        const Vec3 p = in_axes(camera, corner - eye);
        if (!(p.z > 0)) return close_up_angle_deg;
        tangent = std::max({tangent, std::abs(p.x) / p.z, aspect * std::abs(p.y) / p.z});
    }
    const double angle = 2 * std::atan(tangent / (1 - 2 * margin)) * 180 / std::numbers::pi;
    return angle > widest_angle_deg ? close_up_angle_deg : std::max(angle, 1e-6);
}

/// `automatic_angle_deg` across the longer side.
double automatic_horizontal_angle_deg(double aspect) {
    const double longer = std::tan(radians(automatic_angle_deg) / 2);
    return 2 * std::atan(longer * std::min(aspect, 1.0)) * 180 / std::numbers::pi;
}

void place_perspective(Camera& camera, const CameraSetting& setting, const Subject& subject, double aspect) {
    if (setting.location) {
        camera.location = *setting.location;
        camera.angle_deg = setting.angle_deg.value_or(
            fitting_angle_deg(camera, subject, subject.local(*setting.location), aspect));
        return;
    }
    camera.angle_deg = setting.angle_deg.value_or(automatic_horizontal_angle_deg(aspect));
    const Frustum slope(camera.angle_deg, aspect);
    if (setting.look_at) {
        const Vec3 target = subject.local(*setting.look_at);
        const double distance = nearest_distance(camera, subject, target, slope);
        camera.location = subject.world(target - distance * camera.direction);
    } else {
        const Vec3 eye = nearest_eye(camera, subject, slope);
        camera.location = subject.world(eye.x * camera.right + eye.y * camera.up + eye.z * camera.direction);
    }
}

/// The point of which as much lies to the left as to the right, and as much below as above.
Vec3 middle(const Camera& camera, const Subject& subject) {
    const Vec3 centre = in_axes(camera, subject).centre();
    return centre.x * camera.right + centre.y * camera.up + centre.z * camera.direction;
}

/// Takes the outline in place of the corners of the box. The directions are those in which the
/// sides of the picture cut into space, by parallel rays and by those of the automatic angle.
void look_closer(Subject& subject, const Camera& camera, const Outliner& outliner, double aspect) {
    const Frustum slope(automatic_horizontal_angle_deg(aspect), aspect);
    std::vector<Vec3> directions;
    for (const Vec3 side : {camera.right, -camera.right, camera.up, -camera.up})
        directions.push_back(side);
    for (const double sign : {1.0, -1.0}) {
        directions.push_back(sign * camera.right - slope.x * camera.direction);
        directions.push_back(sign * camera.up - slope.y * camera.direction);
    }
    std::vector<Vec3> points = outliner(directions);
    for (Vec3& point : points)
        point = subject.local(point);
    if (!points.empty()) subject.corners = std::move(points);
}

/// Parallel rays start in the plane of the location, so that it lies well in front of the model.
void place_orthographic(Camera& camera, const CameraSetting& setting, const Subject& subject, double aspect) {
    const Vec3 anchor = setting.location  ? subject.local(*setting.location)
                        : setting.look_at ? subject.local(*setting.look_at)
                                          : middle(camera, subject);
    double half_width = 0;
    double nearest = 0;
    for (const Vec3 corner : subject.corners) {
        const Vec3 p = in_axes(camera, corner - anchor);
        half_width = std::max({half_width, std::abs(p.x), aspect * std::abs(p.y)});
        nearest = std::min(nearest, p.z);
    }
    if (half_width == 0) half_width = 1; // a point, or a segment seen along its length
    camera.orthographic = true;
    camera.width = setting.width.value_or(2 * subject.scale * half_width / (1 - 2 * margin));
    if (setting.height) camera.width = std::max(camera.width, aspect * *setting.height);
    camera.location = setting.location.value_or(subject.world(anchor - (3 - nearest) * camera.direction));
}

/// Width over height of what the camera sees of the subject; 1 of a point.
double aspect_of(const Camera& camera, const Subject& subject) {
    Box seen;
    const Vec3 eye = in_axes(camera, subject.local(camera.location));
    for (const Vec3 corner : subject.corners) {
        Vec3 p = in_axes(camera, corner);
        if (!camera.orthographic) p = (p - eye) / std::max((p - eye).z, 1e-6);
        seen.include(p);
    }
    const double width = seen.size().x, height = seen.size().y;
    if (!(width > 0 || height > 0)) return 1;
    return std::max(width, 1e-6 * height) / std::max(height, 1e-6 * width);
}

/// frame_camera(); leaves the subject as closely outlined as it was looked at.
Camera place_camera(const CameraSetting& setting, const Box& bounds, const Outliner& outliner, ImageSize size,
                    bool turning, Subject& subject) {
    const double aspect = static_cast<double>(size.width) / size.height;
    const bool figure = is_figure(bounds);
    Camera camera;
    Vec3 direction = -automatic_eye_direction(bounds);
    if (setting.location) {
        const Vec3 target = setting.look_at ? subject.local(*setting.look_at) : Vec3(0.0);
        const Vec3 sight = target - subject.local(*setting.location);
        const double length = glm::length(sight);
        if (length > 0 && std::isfinite(length)) direction = sight / length;
    } else if (setting.direction) {
        direction = *setting.direction / glm::length(*setting.direction);
    }
    orient(camera, direction, setting.up.value_or(Vec3(0, 1, 0)));
    // Seen face on, the box is exact already.
    if (outliner && (!figure || turning)) look_closer(subject, camera, outliner, aspect);
    if (setting.orthographic || (figure && !setting.location && !setting.angle_deg))
        place_orthographic(camera, setting, subject, aspect);
    else
        place_perspective(camera, setting, subject, aspect);
    if (!setting.location) camera.location = without_noise(camera.location, subject);
    return camera;
}

} // namespace

int thinnest_axis(const Box& bounds) {
    const Vec3 size = 0.5 * bounds.max - 0.5 * bounds.min;
    // Extents that differ by rounding only are equal.
    const double least = std::min({size.x, size.y, size.z});
    const double slack = least + flat_share * std::max({size.x, size.y, size.z});
    for (const int axis : {2, 0})
        if (size[axis] <= slack) return axis;
    return 1;
}

double thickness(const Box& bounds) {
    const Vec3 size = 0.5 * bounds.max - 0.5 * bounds.min;
    const double largest = std::max({size.x, size.y, size.z});
    return largest > 0 ? std::min({size.x, size.y, size.z}) / largest : 0;
}

CameraSetting merge(const CameraSetting& model, const CameraSetting& over) {
    CameraSetting merged = model;
    if (over.location) merged.location = over.location;
    if (over.location) merged.direction = std::nullopt;
    if (over.look_at) merged.look_at = over.look_at;
    if (over.up) merged.up = over.up;
    if (over.angle_deg) merged.angle_deg = over.angle_deg;
    if (over.width) {
        merged.width = over.width;
        merged.height = over.height;
    }
    if (over.aperture) merged.aperture = over.aperture;
    if (over.focus) merged.focus = over.focus;
    if (over.orthographic || over.width)
        merged.orthographic = true;
    else if (over.angle_deg)
        merged.orthographic = false;
    else if (merged.width && !merged.angle_deg)
        merged.orthographic = true;
    return merged;
}

bool is_figure(const Box& bounds) {
    return thickness(bounds) <= thin_share && (thickness(bounds) <= flat_share || thinnest_axis(bounds) != 1);
}

Camera frame_camera(const CameraSetting& setting, const Box& bounds, const Outliner& outliner, ImageSize size,
                    bool turning) {
    Subject subject(bounds);
    return place_camera(setting, bounds, outliner, size, turning, subject);
}

ImageSize shaped_size(const CameraSetting& setting, const Box& bounds, const Outliner& outliner,
                      ImageSize size) {
    const bool whole = setting.width && setting.height;
    if (!whole && (setting.width || (setting.location && setting.angle_deg))) return size;
    Subject subject(bounds);
    const double aspect =
        whole ? *setting.width / *setting.height
              : aspect_of(place_camera(setting, bounds, outliner, size, false, subject), subject);
    constexpr double shapes[] = {16.0 / 9, 3.0 / 2, 4.0 / 3, 1, 3.0 / 4, 2.0 / 3, 9.0 / 16};
    const auto distance = [&](double shape) { return std::abs(std::log(aspect / shape)); };
    const double shape = *std::ranges::min_element(shapes, {}, distance);
    const double pixels = static_cast<double>(size.width) * size.height;
    const auto even = [](double length) {
        return 2 * std::max(1, static_cast<int>(std::lround(length / 2)));
    };
    return {even(std::sqrt(pixels * shape)), even(std::sqrt(pixels / shape))};
}

} // namespace graftal
