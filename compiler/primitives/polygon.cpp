#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include <glm/geometric.hpp>

#include "compiler/primitives/passage.h"
#include "compiler/primitives/polygon_rings.h"
#include "compiler/primitives/shape_parts.h"
#include "compiler/primitives/symmetry_maps.h"
#include "compiler/support/number.h"

namespace graftal {
namespace {

constexpr std::size_t most_corners = 1000;
/// Rays are brought near before they are intersected, but no nearer than some thousand units.
constexpr double most_coordinate = 1000;

class Polygon : public Shape {
  public:
    Polygon(std::string name, PolygonRings outlines)
        : Shape(std::move(name)), rings(std::move(outlines)), triangles(triangulate(rings)) {
        for (const PlanePoint& corner : rings.corners)
            points.emplace_back(corner[0], corner[1], 0);
        box = box_about(points);
        for (const Vec3& point : {box.min, box.max})
            seam =
                std::max({seam, passage_rounding * std::abs(point.x), passage_rounding * std::abs(point.y)});
        for (const auto& [a, b, c] : triangles) {
            pieces.push_back({points[a], points[b], points[c]});
            areas.add(0.5 * glm::length(area_normal(pieces.back())));
        }
    }

    /// Whether a point of the plane lies in an odd number of outlines, or on one.
    bool holds_point(double x, double y) const {
        if (!(x >= box.min.x - seam && x <= box.max.x + seam && y >= box.min.y - seam &&
              y <= box.max.y + seam))
            return false;
        bool inside = false;
        std::uint32_t first = 0;
        for (const std::uint32_t end : rings.ring_ends) {
            for (std::uint32_t i = first, last = end - 1; i < end; last = i++) {
                const PlanePoint &a = rings.corners[last], &b = rings.corners[i];
                const auto [low, high] = std::minmax(a[1], b[1]);
                if (!(y >= low - seam && y <= high + seam)) continue;
                const double across = b[0] - a[0], up = b[1] - a[1];
                const double beyond = (x - a[0]) * up - (y - a[1]) * across;
                const auto [left, right] = std::minmax(a[0], b[0]);
                if (x >= left - seam && x <= right + seam &&
                    std::abs(beyond) <= seam * (std::abs(across) + std::abs(up)))
                    return true;
                if ((a[1] > y) != (b[1] > y) && (beyond < 0) == (up > 0)) inside = !inside;
            }
            first = end;
        }
        return inside;
    }

    PolygonRings rings;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<Vec3> points;
    std::vector<Triangle> pieces;
    AreaSampler areas;
    Box box;
    double seam = 0; ///< a point nearer to an edge is on it
};

const Polygon& form_of(const Primitive& primitive) {
    return shape_of<Polygon>(primitive);
}

std::optional<Primitive> make(std::span<const double> numbers, std::string& fault) {
    if (numbers.size() % 2 != 0) {
        fault = "the corners of a polygon have two coordinates each";
        return std::nullopt;
    }
    for (const double number : numbers)
        if (!(std::abs(number) <= most_coordinate)) {
            fault = "the corners of a polygon have coordinates between -" + shortest(most_coordinate) +
                    " and " + shortest(most_coordinate) + ", not " + shortest(number);
            return std::nullopt;
        }
    std::vector<PlanePoint> points;
    for (std::size_t i = 0; i < numbers.size(); i += 2)
        points.push_back({numbers[i], numbers[i + 1]});
    std::optional<PolygonRings> rings = polygon_rings(points, fault);
    if (!rings) return std::nullopt;
    return Primitive(
        PrimitiveKind::polygon,
        std::make_shared<const Polygon>(shape_name(PrimitiveKind::polygon, numbers), std::move(*rings)));
}

Box box(const Primitive& primitive) {
    return form_of(primitive).box;
}

Ball ball(const Primitive& primitive) {
    return ball_about(form_of(primitive).points);
}

Vec3 support_point(const Primitive& primitive, Vec3 direction) {
    return farthest_of(form_of(primitive).points, direction);
}

/// About the inner radius of a disc as large.
double inner_radius(const Primitive& primitive) {
    const Vec3 size = form_of(primitive).box.size();
    return 0.5 * std::max(std::min(size.x, size.y), 1e-3 * std::max(size.x, size.y));
}

/// Maps that move no point of its plane: other symmetries are not looked for.
bool keeps(const Primitive&, const Affine& map) {
    return turns_about_origin(map) && glm::distance(map.linear[0], Vec3(1, 0, 0)) < symmetry_tolerance &&
           glm::distance(map.linear[1], Vec3(0, 1, 0)) < symmetry_tolerance;
}

TessellatedPrimitive mesh(const Primitive& primitive, int) {
    const Polygon& form = form_of(primitive);
    return {.vertices = form.points, .normals = {}, .triangles = form.triangles};
}

/// The picture over the polygon's box.
TexturePoint texture_point(const Primitive& primitive, const TextureSpace&, Vec3 point) {
    const Box& box = form_of(primitive).box;
    return {(point.x - box.min.x) / box.size().x, (point.y - box.min.y) / box.size().y};
}

double area(const Primitive& primitive) {
    return form_of(primitive).areas.whole();
}

SurfaceSite site(const Primitive& primitive, Vec3 u) {
    const Polygon& form = form_of(primitive);
    return {point_of(form.pieces[form.areas.piece(u.z)], u.x, u.y), {0, 0, 1}};
}

bool intersect(const Primitive& primitive, const Ray& ray, const RayRange& range, PrimitiveHit& hit) {
    // A parallel ray gives a number that is not finite, and no range holds it.
    const double t = -ray.origin.z / ray.direction.z;
    if (!holds(range, t)) return false;
    const double x = ray.origin.x + t * ray.direction.x, y = ray.origin.y + t * ray.direction.y;
    if (!form_of(primitive).holds_point(x, y)) return false;
    hit = {t, {0, 0, 1}};
    return true;
}

} // namespace

const PolygonRings& rings_of(const Primitive& polygon) {
    return form_of(polygon).rings;
}

constinit const PrimitiveTraits polygon_traits = flat_row({
    .arguments = {6, 2 * most_corners},
    .make = make,
    .box = box,
    .ball = ball,
    .support_point = support_point,
    .inner_radius = inner_radius,
    .keeps = keeps,
    .mesh = mesh,
    .texture_point = texture_point,
    .area = area,
    .site = site,
    .intersect = intersect,
});

} // namespace graftal
