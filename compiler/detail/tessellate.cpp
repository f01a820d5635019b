#include "compiler/detail/tessellate.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>

#include "compiler/analysis/bounding.h"
#include "compiler/support/check.h"

namespace graftal {

namespace {

using std::numbers::pi;

constexpr double tube_radius = 0.25;
constexpr int finest = 8;

/// A regular n-gon whose corners are this far out strays from the unit circle by the same length at its
/// corners (outside) and at the middles of its sides (inside).
double balanced_radius(int sides) {
    return 2 / (1 + std::cos(pi / sides));
}
double balanced_error(int sides) {
    return std::pow(std::tan(pi / (2 * sides)), 2);
}

int prism_sides(int fineness) {
    return 3 << fineness;
}
int ring_segments(int fineness) {
    return 6 << fineness;
}
int tube_segments(int fineness) {
    return 3 << fineness;
}

std::uint32_t add_vertex(TessellatedPrimitive& mesh, Vec3 position, Vec3 normal) {
    mesh.vertices.push_back(position);
    mesh.normals.push_back(normal);
    return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
}

/// The unit direction i/n of a turn about the y axis, running from +z to +x: counter-clockwise seen from
/// above.
Vec3 spoke(int i, int n) {
    const double angle = 2 * pi * (i % n) / n;
    return {std::sin(angle), 0, std::cos(angle)};
}

/// The sphere that an octahedron becomes when its edges are halved again and again, on the unit sphere.
TessellatedPrimitive subdivided_octahedron(int fineness) {
    TessellatedPrimitive mesh;
    mesh.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    for (int level = 0; level < fineness; ++level) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [at, added] =
                middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.vertices.size()));
            if (added) mesh.vertices.push_back(glm::normalize(mesh.vertices[a] + mesh.vertices[b]));
            return at->second;
        };
        std::vector<std::array<std::uint32_t, 3>> finer;
        finer.reserve(4 * mesh.triangles.size());
        for (const auto& [a, b, c] : mesh.triangles) {
            const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        mesh.triangles = std::move(finer);
    }
    return mesh;
}

/// How near the flat sides of a mesh inscribed in the unit sphere come to its centre.
double inner_radius(const TessellatedPrimitive& mesh) {
    double least = 1;
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3 corner = mesh.vertices[a];
        const Vec3 normal = glm::cross(mesh.vertices[b] - corner, mesh.vertices[c] - corner);
        least = std::min(least, glm::dot(normal, corner) / glm::length(normal));
    }
    return least;
}

double surface(const TessellatedPrimitive& mesh) {
    double sum = 0;
    for (const auto& [a, b, c] : mesh.triangles)
        sum += 0.5 * glm::length(glm::cross(mesh.vertices[b] - mesh.vertices[a],
                                            mesh.vertices[c] - mesh.vertices[a]));
    return sum;
}

/// How far out the corners of a sphere's mesh lie: such that its shadows are as large as the sphere's, over
/// all directions on average. That of a convex body is a quarter of its surface (Cauchy).
double corner_radius(const TessellatedPrimitive& inscribed) {
    return std::sqrt(4 * pi / surface(inscribed));
}

TessellatedPrimitive make_sphere(int fineness) {
    TessellatedPrimitive mesh = subdivided_octahedron(fineness);
    const double radius = corner_radius(mesh);
    mesh.normals = mesh.vertices;
    for (Vec3& vertex : mesh.vertices)
        vertex *= radius;
    return mesh;
}

/// A cap of n corners, spokes of the given radius at height y, cut into triangles of three equal arcs and
/// then of halves of arcs: no slivers around one corner.
void add_cap(TessellatedPrimitive& mesh, int n, double radius, double y, bool facing_up) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int i = 0; i < n; ++i)
        add_vertex(mesh, radius * spoke(i, n) + Vec3(0, y, 0), {0, facing_up ? 1 : -1, 0});
    const auto add = [&](int a, int b, int c) {
        if (!facing_up) std::swap(b, c);
        const auto corner = [&](int i) { return first + static_cast<std::uint32_t>(i % n); };
        mesh.triangles.push_back({corner(a), corner(b), corner(c)});
    };
    const int third = n / 3;
    add(0, third, 2 * third);
    for (int arc = third; arc > 1; arc /= 2)
        for (int i = 0; i < n; i += arc)
            add(i, i + arc / 2, i + arc);
}

/// A cylinder, or a frustum of this radius at the top.
TessellatedPrimitive make_cylinder(int fineness, double top = 1) {
    TessellatedPrimitive mesh;
    const int n = prism_sides(fineness);
    const double radius = balanced_radius(n);
    for (int i = 0; i < n; ++i)
        for (const double y : {0.0, 1.0})
            add_vertex(mesh, (y > 0 ? top * radius : radius) * spoke(i, n) + Vec3(0, y, 0),
                       glm::normalize(spoke(i, n) + Vec3(0, 1 - top, 0)));
    for (int i = 0; i < n; ++i) {
        const auto low = static_cast<std::uint32_t>(2 * i);
        const auto next_low = static_cast<std::uint32_t>(2 * ((i + 1) % n));
        mesh.triangles.push_back({low, next_low, next_low + 1});
        mesh.triangles.push_back({low, next_low + 1, low + 1});
    }
    add_cap(mesh, n, top * radius, 1, true);
    add_cap(mesh, n, radius, 0, false);
    return mesh;
}

TessellatedPrimitive make_cone(int fineness) {
    TessellatedPrimitive mesh;
    const int n = prism_sides(fineness);
    const double radius = balanced_radius(n);
    const auto outward = [](Vec3 direction) { return glm::normalize(direction + Vec3(0, 1, 0)); };
    for (int i = 0; i < n; ++i)
        add_vertex(mesh, radius * spoke(i, n), outward(spoke(i, n)));
    for (int i = 0; i < n; ++i) {
        // The apex has no normal of its own: each side has one there, that of its middle.
        const std::uint32_t apex = add_vertex(mesh, {0, 1, 0}, outward(spoke(2 * i + 1, 2 * n)));
        mesh.triangles.push_back(
            {static_cast<std::uint32_t>(i), static_cast<std::uint32_t>((i + 1) % n), apex});
    }
    add_cap(mesh, n, radius, 0, false);
    return mesh;
}

/// A corner of the tube's polygon at fraction j/k of its turn, relative to the tube's centre: (outward, up).
std::pair<double, double> tube_corner(int j, int k) {
    const double angle = 2 * pi * (j % k) / k;
    return {std::cos(angle), std::sin(angle)};
}

TessellatedPrimitive make_torus(int fineness) {
    TessellatedPrimitive mesh;
    const int n = ring_segments(fineness), k = tube_segments(fineness);
    const double ring = balanced_radius(n), tube = tube_radius * balanced_radius(k);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < k; ++j) {
            const auto [out, up] = tube_corner(j, k);
            const Vec3 normal = out * spoke(i, n) + Vec3(0, up, 0);
            add_vertex(mesh, ring * spoke(i, n) + tube * normal, normal);
        }
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < k; ++j) {
            const auto at = [&](int a, int b) { return static_cast<std::uint32_t>((a % n) * k + b % k); };
            mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return mesh;
}

/// Each meridian section of the mesh is the tube's polygon, stretched away from the axis by a factor between
/// cos(pi/n) and 1. How far it strays from the tube's circle is largest at a corner or, inwards, on a side.
double torus_error(int fineness) {
    const int n = ring_segments(fineness), k = tube_segments(fineness);
    const double ring = balanced_radius(n), tube = tube_radius * balanced_radius(k);
    constexpr int samples = 64;
    double worst = 0;
    for (int sample = 0; sample <= samples; ++sample) {
        const double stretch = 1 - (1 - std::cos(pi / n)) * sample / samples;
        const auto corner = [&](int j) {
            const auto [out, up] = tube_corner(j, k);
            return Vec3(stretch * (ring + tube * out) - 1, tube * up, 0);
        };
        for (int j = 0; j < k; ++j) {
            const Vec3 a = corner(j), side = corner(j + 1) - a;
            const double t = std::clamp(-glm::dot(a, side) / glm::dot(side, side), 0.0, 1.0);
            worst = std::max({worst, glm::length(a) - tube_radius, tube_radius - glm::length(a + t * side)});
        }
    }
    return worst;
}

TessellatedPrimitive make_cube() {
    TessellatedPrimitive mesh;
    for (int corner = 0; corner < 8; ++corner)
        mesh.vertices.emplace_back(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
        const std::uint32_t u = 1u << (axis + 1) % 3, v = 1u << (axis + 2) % 3, w = 1u << axis;
        // The diagonal of either face runs from the least corner to the greatest.
        mesh.triangles.insert(mesh.triangles.end(),
                              {{w, w | u, w | u | v}, {w, w | u | v, w | v}, {0, u | v, u}, {0, v, u | v}});
    }
    return mesh;
}

TessellatedPrimitive make_triangle() {
    const auto [top, left, right] = triangle_corners();
    return {.vertices = {top, left, right}, .normals = {}, .triangles = {{0, 1, 2}}};
}

TessellatedPrimitive make(PrimitiveKind kind, int fineness) {
    switch (family_of(kind)) {
    case PrimitiveKind::triangle:
        return make_triangle();
    case PrimitiveKind::sphere:
        return make_sphere(fineness);
    case PrimitiveKind::cube:
        return make_cube();
    case PrimitiveKind::cylinder:
        return make_cylinder(fineness);
    case PrimitiveKind::cone:
        return make_cone(fineness);
    case PrimitiveKind::frustum:
        return make_cylinder(fineness, top_radius(kind));
    case PrimitiveKind::torus:
        return make_torus(fineness);
    case PrimitiveKind::plane:
        break;
    }
    GRAFTAL_CHECK(false, "tessellate: a plane has no mesh");
}

double error_of(PrimitiveKind kind, int fineness) {
    switch (family_of(kind)) {
    case PrimitiveKind::sphere: {
        const TessellatedPrimitive inscribed = subdivided_octahedron(fineness);
        const double radius = corner_radius(inscribed);
        return std::max(radius - 1, 1 - radius * inner_radius(inscribed));
    }
    case PrimitiveKind::cylinder:
    case PrimitiveKind::cone:
    case PrimitiveKind::frustum:
        return balanced_error(prism_sides(fineness));
    case PrimitiveKind::torus:
        return torus_error(fineness);
    case PrimitiveKind::triangle:
    case PrimitiveKind::cube:
    case PrimitiveKind::plane:
        break;
    }
    return 0;
}

template<typename Value> class Cache {
  public:
    template<typename Make> const Value& get(PrimitiveKind kind, int fineness, Make make_value) {
        GRAFTAL_CHECK(fineness >= 0 && fineness <= max_fineness(kind), "tessellate: no such fineness");
        Slot& slot = slots_[static_cast<std::size_t>(kind)][static_cast<std::size_t>(fineness)];
        std::call_once(slot.made, [&] { slot.value = make_value(kind, fineness); });
        return slot.value;
    }

  private:
    struct Slot {
        std::once_flag made;
        Value value{};
    };
    std::array<std::array<Slot, finest + 1>, primitive_kind_count> slots_;
};

} // namespace

int max_fineness(PrimitiveKind kind) {
    switch (family_of(kind)) {
    case PrimitiveKind::sphere:
    case PrimitiveKind::torus:
        return 6;
    case PrimitiveKind::cylinder:
    case PrimitiveKind::cone:
    case PrimitiveKind::frustum:
        return finest;
    case PrimitiveKind::triangle:
    case PrimitiveKind::cube:
        return 0;
    case PrimitiveKind::plane:
        break;
    }
    GRAFTAL_CHECK(false, "tessellate: a plane has no mesh");
}

const TessellatedPrimitive& tessellated(PrimitiveKind kind, int fineness) {
    static Cache<TessellatedPrimitive> meshes;
    return meshes.get(kind, fineness, make);
}

double tessellation_error(PrimitiveKind kind, int fineness) {
    static Cache<double> errors;
    return errors.get(kind, fineness, error_of);
}

int fineness_for(PrimitiveKind kind, double tolerance) {
    const int most = max_fineness(kind);
    int fineness = 0;
    while (fineness < most && !(tessellation_error(kind, fineness) <= tolerance))
        ++fineness;
    return fineness;
}

} // namespace graftal
