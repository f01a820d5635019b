#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "compiler/primitives/swept_ring.h"
#include "compiler/primitives/triangle_mesh.h"
#include "compiler/support/number.h"

// sphere_sweep(x, y, z, r, ...): what a ball sweeps whose middle runs along a smooth curve through the points
// (E. Catmull and R. Rom, "A Class of Local Interpolating Splines", 1974), while its radius goes from one
// number to the next. The mesh is the envelope of the balls (a canal surface): rings round the curve, closed
// by a part of the first and of the last ball.

namespace graftal {
namespace {

using std::numbers::pi;

constexpr std::size_t most_points = 100;
constexpr double most_coordinate = 1000;
constexpr int sides = 48;      ///< of a ring: its corners' sides stray from the circle by 0.2 % of its radius
constexpr int least_rings = 2; ///< between two points
constexpr int cap_rows = sides / 4;
/// The radius changes by this share of the way at most; where it changes more, a ball swallows its
/// neighbours.
constexpr double most_slope = 0.98;

struct SweptBall {
    Vec3 centre;
    double radius;
};

/// The way through four points at a share of the way from the second to the third.
Vec3 on_curve(const std::array<Vec3, 4>& p, double t) {
    return 0.5 * (2.0 * p[1] + t * (p[2] - p[0]) + t * t * (2.0 * p[0] - 5.0 * p[1] + 4.0 * p[2] - p[3]) +
                  t * t * t * (3.0 * p[1] - p[0] - 3.0 * p[2] + p[3]));
}
Vec3 speed_on_curve(const std::array<Vec3, 4>& p, double t) {
    return 0.5 * ((p[2] - p[0]) + 2 * t * (2.0 * p[0] - 5.0 * p[1] + 4.0 * p[2] - p[3]) +
                  3 * t * t * (3.0 * p[1] - p[0] - 3.0 * p[2] + p[3]));
}

/// The angle by which a curve turns between its ends is at most that by which its Bezier polygon turns.
double turn_of(const std::array<Vec3, 4>& p) {
    const std::array<Vec3, 3> way = {(p[2] - p[0]) / 6.0, p[2] - p[1] - (p[3] - p[1] + p[2] - p[0]) / 6.0,
                                     (p[3] - p[1]) / 6.0};
    double turn = 0;
    for (std::size_t k = 0; k < 2; ++k)
        turn += std::atan2(glm::length(glm::cross(way[k], way[k + 1])), glm::dot(way[k], way[k + 1]));
    return turn;
}

std::vector<SweptRing> rings_of(const std::vector<SweptBall>& balls) {
    std::vector<SweptRing> rings;
    for (std::size_t i = 0; i + 1 < balls.size(); ++i) {
        const Vec3 a = balls[i].centre, b = balls[i + 1].centre;
        // Beyond its ends the curve goes on as it began.
        const std::array<Vec3, 4> p = {i > 0 ? balls[i - 1].centre : 2.0 * a - b, a, b,
                                       i + 2 < balls.size() ? balls[i + 2].centre : 2.0 * b - a};
        const int steps = std::max(least_rings, static_cast<int>(std::ceil(turn_of(p) / (2 * pi / sides))));
        for (int k = i == 0 ? 0 : 1; k <= steps; ++k) {
            const double t = double(k) / steps;
            const Vec3 speed = speed_on_curve(p, t);
            const double length = glm::length(speed);
            // The radius changes evenly from one point to the next.
            const double change = balls[i + 1].radius - balls[i].radius;
            SweptRing ring{on_curve(p, t), balls[i].radius + t * change, glm::normalize(b - a), 0, Vec3(0.0)};
            if (length > 0) ring.along = speed / length;
            ring.slope = std::clamp(length > 0 ? change / length : 0, -most_slope, most_slope);
            ring.side = rings.empty() ? some_side(ring.along) : moved_side(rings.back(), ring);
            rings.push_back(ring);
        }
    }
    return rings;
}

class SweepMesh {
  public:
    explicit SweepMesh(const std::vector<SweptRing>& rings) {
        const double first = rings.front().slope, last = rings.back().slope;
        double length = 0;
        std::vector<double> at;
        for (std::size_t i = 0; i < rings.size(); ++i)
            at.push_back(i == 0 ? 0 : length += glm::distance(rings[i].centre, rings[i - 1].centre));
        if (!(length > 0)) length = 1;
        // Rings go from the first ball's pole to its ring, along the curve, and to the last ball's pole.
        for (int row = 0; row < cap_rows; ++row)
            add_ring(rings.front(), tilt(-pi / 2, std::asin(-first), row), 0);
        for (std::size_t i = 0; i < rings.size(); ++i)
            add_ring(rings[i], std::asin(-rings[i].slope), at[i] / length);
        for (int row = cap_rows - 1; row >= 0; --row)
            add_ring(rings.back(), tilt(pi / 2, std::asin(-last), row), 1);
    }

    MeshData mesh;

  private:
    static double tilt(double pole, double ring, int row) { return pole + (ring - pole) * row / cap_rows; }

    /// The circle of the ball whose normals lie by an angle off the plane across the curve.
    void add_ring(const SweptRing& ring, double tilt, double v) {
        const Vec3 third = glm::cross(ring.along, ring.side);
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        // A pole is one point to the last bit, or the mesh would not be closed there.
        const double across = std::abs(tilt) == pi / 2 ? 0 : std::cos(tilt);
        for (int i = 0; i < sides; ++i) {
            const double angle = 2 * pi * i / sides;
            const Vec3 normal = across * (std::cos(angle) * ring.side + std::sin(angle) * third) +
                                std::sin(tilt) * ring.along;
            mesh.vertices.push_back(ring.centre + ring.radius * normal);
            mesh.normals.push_back(normal);
        }
        for (std::uint32_t i = 0; i < sides && first > 0; ++i) {
            const std::uint32_t j = (i + 1) % sides, below = first - sides;
            const double u = double(i) / sides, next = double(i + 1) / sides;
            mesh.triangles.push_back({below + i, below + j, first + j});
            mesh.uv.push_back({{{u, last_v_}, {next, last_v_}, {next, v}}});
            mesh.triangles.push_back({below + i, first + j, first + i});
            mesh.uv.push_back({{{u, last_v_}, {next, v}, {u, v}}});
        }
        last_v_ = v;
    }

    double last_v_ = 0;
};

std::optional<Primitive> make(std::span<const double> numbers, std::string& fault) {
    if (numbers.size() % 4 != 0) {
        fault = "a sphere sweep takes four numbers for each point: x, y, z and a radius";
        return std::nullopt;
    }
    std::vector<SweptBall> balls;
    for (std::size_t i = 0; i < numbers.size(); i += 4) {
        for (std::size_t k = 0; k < 4; ++k)
            if (!(std::abs(numbers[i + k]) <= most_coordinate) || (k == 3 && numbers[i + k] < 0)) {
                fault = k < 3 ? "the points of a sphere sweep have coordinates between -" +
                                    shortest(most_coordinate) + " and " + shortest(most_coordinate)
                              : "the radii of a sphere sweep lie between 0 and " + shortest(most_coordinate);
                fault += ", not " + shortest(numbers[i + k]);
                return std::nullopt;
            }
        const SweptBall ball{{numbers[i], numbers[i + 1], numbers[i + 2]}, numbers[i + 3]};
        if (!balls.empty() && balls.back().centre == ball.centre) {
            fault = "two points of a sphere sweep that follow each other are the same";
            return std::nullopt;
        }
        balls.push_back(ball);
    }
    MeshData mesh = without_slivers(SweepMesh(rings_of(balls)).mesh);
    if (mesh.triangles.empty()) {
        fault = "the sphere sweep has no surface: its radii are too small";
        return std::nullopt;
    }
    return Primitive(PrimitiveKind::sphere_sweep,
                     std::make_shared<const TriangleMesh>(shape_name(PrimitiveKind::sphere_sweep, numbers),
                                                          std::move(mesh)));
}

} // namespace

constinit const PrimitiveTraits sphere_sweep_traits = triangle_mesh::traits({8, 4 * most_points}, make);

} // namespace graftal
