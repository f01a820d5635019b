#include "compiler/primitives/limb_sweep.h"

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

// The axis is a curve through the points, which has the direction of both its neighbours' mean in each (a
// cubic Hermite curve): straight where the points are. Rings stand across it, and are carried along without a
// twist. The radius changes evenly from point to point, so that the pieces of a straight limb have the
// volumes of frusta. The far end is half a ball. The near end is flat, or, where the limb leaves another, a
// collar: half a ball about the first point, as wide for a depth, then narrowing smoothly to the limb.

namespace graftal {
namespace {

using std::numbers::pi;

constexpr double most_coordinate = 1000;
constexpr std::size_t head_numbers = 3; ///< before the points
/// Thinner places are points, as a share of the limb's extent.
constexpr double least_radius = 1e-9;
constexpr int collar_rings = 4;
/// The length on which a collar narrows, in its own radii.
constexpr double collar_reach = 2.5;
/// Rings that are closer, as a share of a piece, become one.
constexpr double least_gap = 1e-3;

struct LimbPoint {
    Vec3 place;
    double radius;
};

double ring_growth(int sides) {
    const double turn = 2 * pi / sides;
    return std::sqrt(turn / std::sin(turn));
}

double angle_between(Vec3 a, Vec3 b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

/// The curve from one point to the next.
class Piece {
  public:
    Piece(const LimbPoint& from, const LimbPoint& to, Vec3 from_way, Vec3 to_way)
        : from_(from), to_(to), length_(glm::distance(from.place, to.place)), from_way_(from_way),
          to_way_(to_way) {}

    double length() const { return length_; }
    double slope() const { return (to_.radius - from_.radius) / length_; }
    double radius(double t) const { return from_.radius + t * (to_.radius - from_.radius); }

    Vec3 place(double t) const {
        const double t2 = t * t, t3 = t2 * t;
        return from_.place + (3 * t2 - 2 * t3) * (to_.place - from_.place) +
               length_ * ((t3 - 2 * t2 + t) * from_way_ + (t3 - t2) * to_way_);
    }

    Vec3 way(double t) const {
        const double t2 = t * t;
        const Vec3 speed = 6 * (t - t2) * (to_.place - from_.place) / length_ +
                           (3 * t2 - 4 * t + 1) * from_way_ + (3 * t2 - 2 * t) * to_way_;
        const double size = glm::length(speed);
        return size > 0 ? speed / size : from_way_;
    }

    /// The curve turns at most as its Bezier polygon does.
    double turn() const {
        const Vec3 middle = to_.place - from_.place - length_ / 3 * (from_way_ + to_way_);
        return angle_between(from_way_, middle) + angle_between(middle, to_way_);
    }

  private:
    LimbPoint from_, to_;
    double length_;
    Vec3 from_way_, to_way_;
};

std::vector<Piece> pieces_of(const std::vector<LimbPoint>& points) {
    std::vector<Vec3> straight, ways;
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
        straight.push_back(glm::normalize(points[i + 1].place - points[i].place));
    ways.push_back(straight.front());
    for (std::size_t i = 1; i < straight.size(); ++i) {
        const Vec3 mean = straight[i - 1] + straight[i];
        const double size = glm::length(mean); // 0 where the limb turns back
        ways.push_back(size > 1e-6 ? mean / size : straight[i]);
    }
    ways.push_back(straight.back());
    std::vector<Piece> pieces;
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
        pieces.emplace_back(points[i], points[i + 1], ways[i], ways[i + 1]);
    return pieces;
}

struct Collar {
    double radius = 0; ///< 0: none; the end is flat
    double depth = 0;
    double excess = 0; ///< over the radius of the first point

    double end() const { return depth + collar_reach * radius; }

    /// The excess at a length from the first point, and how it changes.
    double excess_at(double way) const {
        const double left = left_at(way);
        return excess * left * left * left;
    }
    double slope_at(double way) const {
        const double left = left_at(way);
        return way < depth || excess == 0 ? 0 : -3 * excess * left * left / (end() - depth);
    }

  private:
    /// 1 down to the depth, then evenly to 0.
    double left_at(double way) const {
        return excess == 0 ? 0 : std::clamp((end() - way) / (end() - depth), 0.0, 1.0);
    }
};

/// A ring, and the length of the way to it.
struct LimbRing {
    SweptRing ring;
    double way;
};

/// The shares of a piece at which rings stand, without its beginning.
std::vector<double> shares(const Piece& piece, double way, const Collar& collar, int sides) {
    std::vector<double> all;
    const int steps = std::max(1, static_cast<int>(std::ceil(piece.turn() / (2 * pi / sides) - 1e-9)));
    for (int k = 1; k <= steps; ++k)
        all.push_back(double(k) / steps);
    for (int k = 0; collar.excess > 0 && k <= collar_rings; ++k) {
        const double t =
            (collar.depth + k * (collar.end() - collar.depth) / collar_rings - way) / piece.length();
        const auto is_near = [&](double other) { return std::abs(other - t) < least_gap; };
        if (t > least_gap && t < 1 && std::ranges::none_of(all, is_near)) all.push_back(t);
    }
    std::ranges::sort(all);
    return all;
}

std::vector<LimbRing> rings_of(const std::vector<Piece>& pieces, const Collar& collar, int sides) {
    std::vector<LimbRing> rings;
    double way = 0;
    const auto add = [&](const Piece& piece, double t, double slope) {
        const double here = way + t * piece.length();
        SweptRing ring{piece.place(t), piece.radius(t) + collar.excess_at(here), piece.way(t),
                       slope + collar.slope_at(here), Vec3(0.0)};
        ring.side = rings.empty() ? some_side(ring.along) : moved_side(rings.back().ring, ring);
        rings.push_back({ring, here});
    };
    add(pieces.front(), 0, pieces.front().slope());
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const Piece& piece = pieces[i];
        const double next = i + 1 < pieces.size() ? pieces[i + 1].slope() : piece.slope();
        for (const double t : shares(piece, way, collar, sides))
            add(piece, t, t < 1 ? piece.slope() : (piece.slope() + next) / 2);
        way += piece.length();
    }
    return rings;
}

/// The mesh, ring by ring from the near end to the far one. v is the length of the way in circumferences of
/// the limb in the mean, so that pictures keep their proportions; u is the share of the turn.
class LimbMesh {
  public:
    LimbMesh(const std::vector<LimbRing>& rings, const Collar& collar, int sides, double circumference,
             double extent)
        : sides_(static_cast<std::uint32_t>(sides)), growth_(ring_growth(sides)),
          circumference_(circumference), thinnest_(least_radius * extent),
          grid_(std::ldexp(1.0, std::ilogb(extent) - 40)) {
        begin(rings.front().ring, collar);
        for (const LimbRing& ring : rings)
            add_ring(ring.ring, std::atan(-ring.ring.slope), ring.way);
        const SweptRing& last = rings.back().ring;
        const double radius = last.radius;
        const int rows = std::max(1, sides / 4);
        for (int row = 1; row < rows && radius > thinnest_; ++row)
            add_ring(on_ball(last, pi / 2 * row / rows), pi / 2 * row / rows,
                     rings.back().way + radius * pi / 2 * row / rows);
        const double tip = radius > thinnest_ ? growth_ * radius : 0;
        add_end(last.centre + tip * last.along, last.along, rings.back().way + radius * pi / 2);
    }

    MeshData mesh;

  private:
    static SweptRing on_ball(SweptRing ring, double tilt) {
        ring.centre += ring.radius * std::sin(tilt) * ring.along;
        ring.radius *= std::cos(tilt);
        return ring;
    }

    void begin(const SweptRing& first, const Collar& collar) {
        const double radius = first.radius;
        if (collar.radius > 0 && radius > thinnest_) {
            constexpr double tilt = -pi / 4;
            add_start(first.centre - growth_ * radius * first.along, -first.along, -radius * pi / 2);
            add_ring(on_ball(first, tilt), tilt, radius * tilt);
        } else {
            add_start(first.centre, -first.along, -radius);
            add_ring(first, -pi / 2, 0); // the edge has two normals
            sharp_ = true;
        }
    }

    /// Vertices lie on a fine grid, so that those that meet are equal.
    void add_vertex(Vec3 place, Vec3 normal) {
        for (int k = 0; k < 3; ++k)
            place[k] = std::round(place[k] / grid_) * grid_ + 0.0; // no negative zeros
        mesh.vertices.push_back(place);
        mesh.normals.push_back(normal);
    }

    void add_triangle(std::array<std::uint32_t, 3> corners, const std::array<std::array<double, 2>, 3>& uv) {
        mesh.triangles.push_back(corners);
        mesh.uv.push_back(uv);
    }

    void add_start(Vec3 place, Vec3 normal, double way) {
        add_vertex(place, normal);
        last_v_ = way / circumference_;
    }

    /// `tilt`: of the normals towards the direction of the limb.
    void add_ring(const SweptRing& ring, double tilt, double way) {
        const Vec3 third = glm::cross(ring.along, ring.side);
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        const double radius = ring.radius > thinnest_ ? growth_ * ring.radius : 0;
        const double v = way / circumference_;
        for (std::uint32_t i = 0; i < sides_; ++i) {
            const double angle = 2 * pi * i / sides_;
            const Vec3 out = std::cos(angle) * ring.side + std::sin(angle) * third;
            add_vertex(ring.centre + radius * out, std::cos(tilt) * out + std::sin(tilt) * ring.along);
        }
        const bool joins = !sharp_;
        sharp_ = false;
        if (joins) join(first, v);
        last_v_ = v;
    }

    /// Joins the ring that begins at this vertex with the one before, or with the point before the first.
    void join(std::uint32_t first, double v) {
        for (std::uint32_t i = 0; i < sides_; ++i) {
            const std::uint32_t j = (i + 1) % sides_;
            const double u = double(i) / sides_, next = double(i + 1) / sides_;
            if (first == 1) {
                add_triangle({0, first + j, first + i}, {{{(u + next) / 2, last_v_}, {next, v}, {u, v}}});
                continue;
            }
            const std::uint32_t below = first - sides_;
            add_triangle({below + i, below + j, first + j}, {{{u, last_v_}, {next, last_v_}, {next, v}}});
            add_triangle({below + i, first + j, first + i}, {{{u, last_v_}, {next, v}, {u, v}}});
        }
    }

    void add_end(Vec3 place, Vec3 normal, double way) {
        const auto end = static_cast<std::uint32_t>(mesh.vertices.size());
        add_vertex(place, normal);
        for (std::uint32_t i = 0; i < sides_; ++i) {
            const std::uint32_t below = end - sides_;
            const double u = double(i) / sides_, next = double(i + 1) / sides_;
            add_triangle({below + i, below + (i + 1) % sides_, end},
                         {{{u, last_v_}, {next, last_v_}, {(u + next) / 2, way / circumference_}}});
        }
    }

    std::uint32_t sides_;
    double growth_, circumference_, thinnest_, grid_;
    double last_v_ = 0;
    bool sharp_ = false; ///< the ring before is doubled by the next
};

std::string fault_of(std::span<const double> numbers) {
    const double sides = numbers[0];
    if (!(sides >= least_limb_sides && sides <= most_limb_sides && sides == std::floor(sides)))
        return "a limb sweep has from " + std::to_string(least_limb_sides) + " to " +
               std::to_string(most_limb_sides) + " sides, not " + shortest(sides);
    if ((numbers.size() - head_numbers) % 4 != 0)
        return "a limb sweep takes its sides, collar and depth, and four numbers for each point: x, y, z and "
               "a radius";
    for (std::size_t i = 1; i < numbers.size(); ++i) {
        const bool is_size = i < head_numbers || (i - head_numbers) % 4 == 3;
        if (std::abs(numbers[i]) <= most_coordinate && !(is_size && numbers[i] < 0)) continue;
        const std::string most = shortest(most_coordinate);
        return (is_size ? "the radii, collar and depth of a limb sweep lie between 0 and " + most
                        : "the points of a limb sweep have coordinates between -" + most + " and " + most) +
               ", not " + shortest(numbers[i]);
    }
    return {};
}

std::optional<Primitive> make(std::span<const double> numbers, std::string& fault) {
    if (fault = fault_of(numbers); !fault.empty()) return std::nullopt;
    std::vector<LimbPoint> points;
    double length = 0, thickest = 0, farthest = 0, area = 0;
    for (std::size_t i = head_numbers; i < numbers.size(); i += 4) {
        const LimbPoint point{{numbers[i], numbers[i + 1], numbers[i + 2]}, numbers[i + 3]};
        if (!points.empty()) {
            const double step = glm::distance(points.back().place, point.place);
            if (!(step > 0)) {
                fault = "two points of a limb sweep that follow each other are the same";
                return std::nullopt;
            }
            length += step;
            area += step * (points.back().radius + point.radius) / 2;
        }
        thickest = std::max(thickest, point.radius);
        farthest = std::max(farthest, largest_entry(point.place));
        points.push_back(point);
    }
    const int sides = static_cast<int>(numbers[0]);
    Collar collar{numbers[1], numbers[2], 0};
    collar.excess = collar.radius > 0 ? std::max(0.0, collar.radius - points.front().radius) : 0;
    const double extent = std::max({farthest, length, thickest, collar.radius});
    const LimbMesh surface(rings_of(pieces_of(points), collar, sides), collar, sides,
                           2 * pi * std::max(area / length, least_radius * extent), extent);
    MeshData mesh = without_slivers(surface.mesh, true);
    if (mesh.triangles.empty()) {
        fault = "the limb sweep has no surface: its radii are too small";
        return std::nullopt;
    }
    return Primitive(PrimitiveKind::limb_sweep,
                     std::make_shared<const TriangleMesh>(shape_name(PrimitiveKind::limb_sweep, numbers),
                                                          std::move(mesh)));
}

/// A picture goes round as often as the material says, and along so that it keeps its proportions.
TexturePoint repeated(TexturePoint point, const TextureSpace& space) {
    return {space.around * point[0], space.around * point[1]};
}

TexturePoint texture_point(const Primitive& primitive, const TextureSpace& space, Vec3 point) {
    return repeated(triangle_mesh::texture_point(primitive, space, point), space);
}

std::array<TexturePoint, 3> texture_triangle(const Primitive& primitive, const TextureSpace& space,
                                             const std::array<Vec3, 3>& points) {
    std::array<TexturePoint, 3> uv = triangle_mesh::texture_triangle(primitive, space, points);
    for (TexturePoint& point : uv)
        point = repeated(point, space);
    return uv;
}

} // namespace

int limb_sides(double tolerance) {
    int sides = least_limb_sides;
    while (sides < most_limb_sides && std::max(ring_growth(sides) - 1, limb_dent(sides)) > tolerance)
        ++sides;
    return sides;
}

double limb_dent(int sides) {
    return 1 - ring_growth(sides) * std::cos(pi / sides);
}

std::size_t limb_triangles(const Primitive& limb) {
    return shape_of<TriangleMesh>(limb).data.triangles.size();
}

constinit const PrimitiveTraits limb_sweep_traits = [] {
    PrimitiveTraits row =
        triangle_mesh::traits({head_numbers + 8, head_numbers + 4 * most_limb_points}, make);
    row.wrap = {.around = true, .evenly = true};
    row.texture_point = texture_point;
    row.texture_triangle = texture_triangle;
    return row;
}();

} // namespace graftal
