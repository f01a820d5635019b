#include "runtime/export/formats/plane_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "compiler/scene/framing.h"

namespace graftal {

namespace {

/// Whether the model is nothing but lines, and balls where they meet, whose axes lie in one plane: where
/// lines are few, they may be thick.
bool lies_in_plane(const UnfoldedScene& scene, int axis) {
    constexpr double flat = 1e-9;
    constexpr std::size_t most_leaves = 1'000'000;
    const double height = scene.bounds.centre()[axis];
    const double off = flat * largest_entry(scene.bounds.size());
    std::size_t leaves = 0;
    bool has_lines = false;
    const bool all = walk_leaves(scene, scene.root, {}, {}, [&](const SceneLeaf& leaf) {
        const PrimitiveKind kind = scene.shapes[leaf.shape].primitive.kind();
        const bool is_line =
            kind == PrimitiveKind::cylinder || kind == PrimitiveKind::cone || kind == PrimitiveKind::frustum;
        has_lines = has_lines || is_line;
        const Affine& place = leaf.world_from_shape;
        return ++leaves <= most_leaves && (is_line || kind == PrimitiveKind::sphere) &&
               std::abs(place.translation[axis] - height) <= off &&
               (!is_line || std::abs(place.linear[1][axis]) <= off);
    });
    return all && has_lines;
}

} // namespace

Affine2 operator*(const Affine2& a, const Affine2& b) {
    Affine2 product;
    for (std::size_t column = 0; column < 2; ++column)
        for (std::size_t row = 0; row < 2; ++row)
            product.linear[2 * column + row] =
                a.linear[row] * b.linear[2 * column] + a.linear[2 + row] * b.linear[2 * column + 1];
    product.translation = a(b.translation);
    return product;
}

SeenFrame::SeenFrame(Vec3 along) : along_(glm::normalize(along)) {
    // One direction of the two, and without what rounding leaves: frames that are seen alike are equal then.
    for (int axis = 0; axis < 3; ++axis)
        along_[axis] = std::round(along_[axis] * 1e9) / 1e9 + 0.0;
    along_ = glm::normalize(along_);
    const bool back = along_.z != 0 ? along_.z < 0 : along_.y != 0 ? along_.y < 0 : along_.x < 0;
    if (back) along_ = -along_;
    if (along_ == Vec3(0, 0, 1)) return;
    const Vec3 up = std::abs(along_.y) < 0.9 ? Vec3(0, 1, 0) : Vec3(0, 0, -1);
    x_ = glm::normalize(glm::cross(up, along_));
    y_ = glm::cross(along_, x_);
}

SeenFrame SeenFrame::of_part(const Affine& frame_from_part) const {
    const double size = largest_entry(frame_from_part.linear);
    return SeenFrame(glm::inverse(frame_from_part.linear / size) * along_);
}

Affine2 SeenFrame::picture_of(const SeenFrame& part, const Affine& frame_from_part) const {
    const Point2 x = (*this)(frame_from_part.linear * part.x_), y = (*this)(frame_from_part.linear * part.y_);
    return {{x[0], x[1], y[0], y[1]}, (*this)(frame_from_part.translation)};
}

std::optional<PlanePage> page_of(const ExportJob& job, std::optional<double> unit) {
    const Box& box = job.scene.bounds;
    if (box.empty() || !(is_figure(box) || lies_in_plane(job.scene, thinnest_axis(box)))) {
        job.diagnostics
            .error(job.model,
                   fmt::format("the model is in no plane: it is {:.3g} thick where it measures {:.3g}",
                               box.empty() ? 0 : thickness(box) * largest_entry(box.size()),
                               box.empty() ? 0 : largest_entry(box.size())))
            .with_hint("choose a format in space, such as .glb, or draw it with 'graftal render'");
        return std::nullopt;
    }
    const int axis = thinnest_axis(box);
    Vec3 along(0.0);
    along[axis] = 1;
    const Camera& eye = job.view.camera;
    PlanePage page;
    page.world = SeenFrame(along);
    const bool faces = std::abs(glm::dot(eye.direction, along)) > 1 - 1e-9;
    const Vec3 middle = box.centre();
    const double aspect = static_cast<double>(job.view.size.height) / job.view.size.width;
    Vec3 right(axis == 0 ? 0 : 1, 0, axis == 0 ? -1 : 0), up(0, axis == 1 ? 0 : 1, axis == 1 ? -1 : 0);
    Vec3 centre = middle;
    double width = 0, height = 0; // of the page, in the model's units
    if (faces) {
        right = eye.right;
        up = eye.up;
        centre = eye.location;
        const double away = std::abs(glm::dot(middle - eye.location, eye.direction));
        width =
            eye.orthographic ? eye.width : 2 * away * std::tan(0.5 * eye.angle_deg * std::numbers::pi / 180);
        height = width * aspect;
    } else {
        constexpr double margin = 1.1; // the margin that pictures have
        for (const Vec3& corner : box.corners()) {
            width = std::max(width, 2 * margin * std::abs(glm::dot(corner - middle, right)));
            height = std::max(height, 2 * margin * std::abs(glm::dot(corner - middle, up)));
        }
    }
    const double scale = unit ? *unit : job.view.size.width / width;
    page.scale = scale;
    page.width = width * scale;
    page.height = height * scale;
    // World's own picture -> page: the camera's right and down.
    const Affine into{glm::transpose(Mat3(right, -up, along)), Vec3(0.0)};
    const SeenFrame flat(Vec3(0, 0, 1));
    page.page_from_world = flat.picture_of(page.world, into);
    for (double& entry : page.page_from_world.linear)
        entry *= scale;
    page.page_from_world.translation = {0.5 * page.width - scale * glm::dot(right, centre),
                                        0.5 * page.height + scale * glm::dot(up, centre)};
    return page;
}

std::vector<Point2> convex_outline(std::vector<Point2> points) {
    // A. Andrew's monotone chain, 1979.
    std::ranges::sort(points);
    points.erase(std::unique(points.begin(), points.end()), points.end());
    if (points.size() < 3) return points;
    const auto turn = [](const Point2& o, const Point2& a, const Point2& b) {
        return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
    };
    std::vector<Point2> outline;
    for (const int pass : {0, 1}) {
        const std::size_t first = outline.size();
        for (const Point2& point : points) {
            while (outline.size() >= first + 2 &&
                   turn(outline[outline.size() - 2], outline.back(), point) <= 0)
                outline.pop_back();
            outline.push_back(point);
        }
        outline.pop_back();
        if (pass == 0) std::ranges::reverse(points);
    }
    return outline;
}

} // namespace graftal
