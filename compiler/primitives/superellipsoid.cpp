#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include <glm/geometric.hpp>

#include "compiler/primitives/passage.h"
#include "compiler/primitives/shape_parts.h"
#include "compiler/primitives/symmetry_maps.h"
#include "compiler/primitives/texture_space.h"
#include "compiler/support/number.h"

// superellipsoid(e, n): where (|x|^(2/e) + |z|^(2/e))^(e/n) + |y|^(2/n) <= 1, as A. Barr has it
// ("Superquadrics and Angle-Preserving Transformations", 1981), with y for its axis. The exponents lie
// between 0.1 and 2. So it is the unit ball of a norm, a p-norm of (rho, y) over a p-norm rho of (x, z), and
// convex: its support is that of the dual norm, and a ray meets it where a convex function is 1.

namespace graftal {
namespace {

using std::numbers::pi;

constexpr double least_exponent = 0.1, most_exponent = 2;

/// The norm (|a|^p + |b|^p)^(1/p), which neither overflows nor vanishes.
double norm_of(double a, double b, double p) {
    a = std::abs(a);
    b = std::abs(b);
    if (a < b) std::swap(a, b);
    if (!(b > 0)) return a;
    if (std::isinf(p)) return a;
    return a * std::pow(1 + std::pow(b / a, p), 1 / p);
}

/// The gradient of that norm; where it has none, one of its subgradients.
std::array<double, 2> gradient_of(double a, double b, double p) {
    const double norm = norm_of(a, b, p);
    if (!(norm > 0)) return {0, 0};
    if (std::isinf(p))
        return std::abs(a) >= std::abs(b) ? std::array{std::copysign(1.0, a), 0.0}
                                          : std::array{0.0, std::copysign(1.0, b)};
    const auto part = [&](double x) {
        return x == 0 ? 0 : std::copysign(std::pow(std::abs(x) / norm, p - 1), x);
    };
    return {part(a), part(b)};
}

double dual(double p) {
    return p > 1 ? p / (p - 1) : std::numeric_limits<double>::infinity();
}

/// The norm of two exponents: across p of x and z, up q of that and y.
struct Norm {
    double p, q;

    double operator()(Vec3 v) const { return norm_of(norm_of(v.x, v.z, p), v.y, q); }
    Vec3 gradient(Vec3 v) const {
        const auto [x, z] = gradient_of(v.x, v.z, p);
        const auto [rho, y] = gradient_of(norm_of(v.x, v.z, p), v.y, q);
        return {rho * x, y, rho * z};
    }
};

class Superellipsoid : public Shape {
  public:
    Superellipsoid(double east, double north)
        : Shape(shape_name(PrimitiveKind::superellipsoid, std::array{east, north})), e(east),
          n(north), norm{2 / east, 2 / north} {}

    const double e, n;
    const Norm norm;
};

const Superellipsoid& form_of(const Primitive& primitive) {
    return shape_of<Superellipsoid>(primitive);
}

std::optional<Primitive> make(std::span<const double> numbers, std::string& fault) {
    for (const double exponent : numbers)
        if (!(exponent >= least_exponent && exponent <= most_exponent)) {
            fault = "the exponents of a superellipsoid lie between " + shortest(least_exponent) + " and " +
                    shortest(most_exponent) + ", not at " + shortest(exponent);
            return std::nullopt;
        }
    return Primitive(PrimitiveKind::superellipsoid,
                     std::make_shared<const Superellipsoid>(numbers[0], numbers[1]));
}

Box box(const Primitive&) {
    return {Vec3(-1.0), Vec3(1.0)};
}

/// The greatest length of (a, b) with |(a, b)|_p = 1 where a counts `stretch` times.
double longest(double stretch, double p) {
    if (p <= 2) return std::max(stretch, 1.0);
    const double t = p / (p - 2); // dual to p / 2, for the squares
    return std::sqrt(norm_of(stretch * stretch, 1, t));
}

Ball ball(const Primitive& primitive) {
    const Norm& norm = form_of(primitive).norm;
    return {Vec3(0.0), longest(longest(1, norm.p), norm.q) * (1 + 1e-14)};
}

Vec3 support_point(const Primitive& primitive, Vec3 direction) {
    const Norm& norm = form_of(primitive).norm;
    const double largest = std::max({std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)});
    if (!(largest > 0)) return {1, 0, 0};
    return Norm{dual(norm.p), dual(norm.q)}.gradient(direction / largest);
}

int rows(int fineness) {
    return 4 << fineness;
}

double power(double x, double exponent) {
    constexpr double nothing = 1e-12; // the cosine of a right angle, rounded
    return std::abs(x) < nothing ? 0 : std::copysign(std::pow(std::abs(x), exponent), x);
}

/// A mesh by longitude and latitude, which gather where the surface bends. Corners lie on the surface.
TessellatedPrimitive mesh(const Primitive& primitive, int fineness) {
    const Superellipsoid& form = form_of(primitive);
    TessellatedPrimitive mesh;
    const int half = rows(fineness), around = 2 * half;
    const auto add = [&](Vec3 v) {
        mesh.vertices.push_back(v);
        mesh.normals.push_back(glm::normalize(form.norm.gradient(v)));
        return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
    };
    const std::uint32_t bottom = add({0, -1, 0});
    for (int row = 1; row < half; ++row) {
        const double latitude = pi * row / half - pi / 2;
        const double out = power(std::cos(latitude), form.n), y = power(std::sin(latitude), form.n);
        for (int i = 0; i < around; ++i) {
            const double longitude = 2 * pi * i / around;
            add({out * power(std::sin(longitude), form.e), y, out * power(std::cos(longitude), form.e)});
        }
    }
    const std::uint32_t top = add({0, 1, 0});
    const auto at = [&](int row, int i) {
        return bottom + 1 + static_cast<std::uint32_t>((row - 1) * around + i % around);
    };
    for (int i = 0; i < around; ++i) {
        mesh.triangles.push_back({bottom, at(1, i + 1), at(1, i)});
        for (int row = 1; row + 1 < half; ++row) {
            mesh.triangles.push_back({at(row, i), at(row, i + 1), at(row + 1, i + 1)});
            mesh.triangles.push_back({at(row, i), at(row + 1, i + 1), at(row + 1, i)});
        }
        mesh.triangles.push_back({at(half - 1, i), at(half - 1, i + 1), top});
    }
    return mesh;
}

/// The greatest distance of a point of a triangle from where its ray from the middle leaves the body.
double mesh_error(const Primitive& primitive, int fineness) {
    constexpr int grid = 4;
    const Norm& norm = form_of(primitive).norm;
    const TessellatedPrimitive shape = mesh(primitive, fineness);
    double worst = 0;
    for (const auto& [a, b, c] : shape.triangles)
        for (int i = 0; i <= grid; ++i)
            for (int j = 0; i + j <= grid; ++j) {
                const Vec3 p = (double(i) * shape.vertices[a] + double(j) * shape.vertices[b] +
                                double(grid - i - j) * shape.vertices[c]) /
                               double(grid);
                worst = std::max(worst, (1 / norm(p) - 1) * glm::length(p));
            }
    return 1.1 * worst;
}

constexpr int finest = 5;
constexpr int coarse = 1;

std::vector<HullPiece> hull(const Primitive&) {
    std::vector<HullPiece> pieces;
    for (const Vec3& corner : Box{Vec3(-1.0), Vec3(1.0)}.corners())
        pieces.push_back({HullPiece::Kind::point, Affine::translate(corner)});
    return pieces;
}

std::vector<ConvexPart> convex_parts(const Primitive& primitive) {
    return {{mesh(primitive, coarse).vertices, 0}};
}

double inner_radius(const Primitive&) {
    return 0.5; // of the octahedron 0.58
}

/// Signs of the axes, and x and z exchanged.
bool keeps(const Primitive&, const Affine& map) {
    if (!turns_about_origin(map) || !keeps_y_axis(map.linear)) return false;
    const auto is_near = [](double x, double y) { return std::abs(x - y) < symmetry_tolerance; };
    const double along = std::abs(map.linear[0].x);
    return is_near(along, 0) || is_near(along, 1);
}

/// u round the y axis, v by latitude.
TexturePoint texture_point(const Primitive&, const TextureSpace& space, Vec3 point) {
    return {turn_about_y(space, point),
            0.5 + std::asin(std::clamp(point.y / glm::length(point), -1.0, 1.0)) / pi};
}

/// A fine mesh, whose triangles stand for the surface outside of them.
struct Skin {
    std::vector<Triangle> triangles;
    AreaSampler areas;
};

const Skin& skin_of(const Primitive& primitive) {
    static const char key = 0;
    return primitive.shape()->derived<Skin>(&key, [&] {
        Skin skin;
        const TessellatedPrimitive fine = mesh(primitive, finest - 1);
        for (const auto& [a, b, c] : fine.triangles) {
            skin.triangles.push_back({fine.vertices[a], fine.vertices[b], fine.vertices[c]});
            skin.areas.add(0.5 * glm::length(area_normal(skin.triangles.back())));
        }
        return skin;
    });
}

double area(const Primitive& primitive) {
    return skin_of(primitive).areas.whole();
}

double beta(double a, double b) {
    return std::exp(std::lgamma(a) + std::lgamma(b) - std::lgamma(a + b));
}

/// A. Jaklic, A. Leonardis, F. Solina, "Segmentation and Recovery of Superquadrics", 2000,
/// chapter 2.
double volume(const Primitive& primitive) {
    const double e = form_of(primitive).e, n = form_of(primitive).n;
    return 2 * e * n * beta(n / 2 + 1, n) * beta(e / 2, e / 2);
}

SurfaceSite site(const Primitive& primitive, Vec3 u) {
    const Norm& norm = form_of(primitive).norm;
    const Skin& skin = skin_of(primitive);
    const Vec3 inside = point_of(skin.triangles[skin.areas.piece(u.z)], u.x, u.y);
    const Vec3 point = inside / norm(inside);
    return {point, glm::normalize(norm.gradient(point))};
}

/// Where a convex function that is at least 1 at `out` and below 1 at `in` is 1. Newton's method comes from
/// outside and never passes the root; halving helps it where the function is flat or has a kink.
template<typename Function> double crossing(const Function& f, double out, double in) {
    constexpr double rounding = 4e-16;
    for (int step = 0; step < 200; ++step) {
        const auto [value, slope] = f(out);
        if (!(value > 1)) return out;
        const double newton = out - (value - 1) / slope;
        const bool helps = std::abs(newton - in) < std::abs(out - in) && (newton > in) == (out > in);
        double next = helps ? newton : out;
        const double middle = 0.5 * (next + in);
        if (f(middle).first < 1)
            in = middle;
        else
            next = middle;
        const double small = rounding * std::max(1.0, std::abs(next));
        if (std::abs(in - next) <= small || (next == newton && std::abs(next - out) <= small)) return next;
        out = next;
    }
    return out;
}

/// The powers of one point, in nodes of a mesh's tree that take as long.
constexpr std::uint64_t steps_a_point = 7;

bool intersect(const Primitive& primitive, const Ray& ray, const RayRange& range, PrimitiveHit& hit) {
    hit.steps = 0;
    const Norm& norm = form_of(primitive).norm;
    const Vec3 &o = ray.origin, &d = ray.direction;
    const Passage within =
        both(both(between(-1, 1, o.x, d.x), between(-1, 1, o.y, d.y)), between(-1, 1, o.z, d.z));
    if (!(within.enter <= within.leave)) return false;
    // The search begins in the middle of the box, where numbers are small.
    const double middle = 0.5 * (within.enter + within.leave), half = 0.5 * (within.leave - within.enter);
    if (!std::isfinite(middle) || !std::isfinite(half)) return false;
    const Vec3 start = ray(middle);
    const auto f = [&](double t) {
        hit.steps += steps_a_point;
        const Vec3 p = start + t * d;
        return std::pair(norm(p), glm::dot(norm.gradient(p), d));
    };
    // A point inside, or none: the least value lies where the slope changes its sign.
    double low = -half, high = half, inside = 0;
    bool found = false;
    for (int step = 0; step < 100 && !found; ++step) {
        inside = 0.5 * (low + high);
        const auto [value, slope] = f(inside);
        found = value < 1;
        if (slope > 0)
            high = inside;
        else
            low = inside;
        if (!(high - low > 1e-15)) break;
        // Convex: no value between is less than where the two tangents meet.
        if (!found && value - std::abs(slope) * (high - low) >= 1) return false;
    }
    if (!found) return false;
    const double enter = middle + crossing(f, -half, inside);
    PassageEnd end;
    const double leave = enter > range.least ? enter : middle + crossing(f, half, inside);
    if (!first_end({enter, leave}, range, end)) return false;
    hit.t = end.t;
    hit.normal = glm::normalize(norm.gradient(start + (end.t - middle) * d));
    return true;
}

} // namespace

constinit const PrimitiveTraits superellipsoid_traits = {
    .arguments = {2, 2},
    .make = make,
    .box = box,
    .ball = ball,
    .support_point = support_point,
    .hull = hull,
    .convex_parts = convex_parts,
    .inner_radius = inner_radius,
    .fixed_point = origin_of,
    .keeps = keeps,
    .max_fineness = finest,
    .mesh = mesh,
    .mesh_error = mesh_error,
    .wrap = {.around = true},
    .texture_point = texture_point,
    .area = area,
    .volume = volume,
    .site = site,
    .intersect = intersect,
};

} // namespace graftal
