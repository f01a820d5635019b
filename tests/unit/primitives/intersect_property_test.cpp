// Laws that hold for rays at random, by means that share nothing with the code under test: functions that are
// negative inside of each solid, sampled densely, and the meshes that the cut bakes.

#include "compiler/primitives/intersect.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "compiler/primitives/tapered.h"
#include "compiler/primitives/tessellate.h"

namespace graftal {
namespace {

const Primitive solids[] = {PrimitiveKind::sphere, PrimitiveKind::cube,  PrimitiveKind::cylinder,
                            PrimitiveKind::cone,   PrimitiveKind::torus, tapered(1. / 128),
                            tapered(0.25),         tapered(0.75),        tapered(127. / 128)};

double out_of(Vec3 p) {
    return std::sqrt(p.x * p.x + p.z * p.z);
}

/// Distances from the faces that bound a solid, negative inwards: a solid is where all are.
std::array<double, 3> faces(const Primitive& kind, Vec3 p) {
    switch (kind.kind()) {
    case PrimitiveKind::sphere:
        return {glm::length(p) - 1, -2, -2};
    case PrimitiveKind::cube:
        return {std::abs(p.x) - 1, std::abs(p.y) - 1, std::abs(p.z) - 1};
    case PrimitiveKind::torus: {
        const double across = out_of(p) - 1;
        return {std::sqrt(across * across + p.y * p.y) - 0.25, -2, -2};
    }
    default: {
        const double slope = 1 - top_radius(kind);
        return {-p.y, p.y - 1, (out_of(p) - 1 + slope * p.y) / std::sqrt(1 + slope * slope)};
    }
    }
}

double outside(const Primitive& kind, Vec3 p) {
    const auto all = faces(kind, p);
    return std::max({all[0], all[1], all[2]});
}

/// Whether two faces are so near that a gradient by differences means nothing.
bool near_edge(const Primitive& kind, Vec3 p) {
    auto all = faces(kind, p);
    std::sort(all.begin(), all.end());
    return all[2] - all[1] < 1e-4 || out_of(p) < 1e-3;
}

Vec3 gradient(const Primitive& kind, Vec3 p) {
    constexpr double h = 1e-6;
    Vec3 result;
    for (int i = 0; i < 3; ++i) {
        Vec3 step(0.0);
        step[i] = h;
        result[i] = (outside(kind, p + step) - outside(kind, p - step)) / (2 * h);
    }
    return result;
}

class RandomRays {
  public:
    explicit RandomRays(unsigned seed) : random_(seed) {}

    double uniform(double least, double most) {
        return std::uniform_real_distribution<double>(least, most)(random_);
    }
    Vec3 in_box(double size) { return {uniform(-size, size), uniform(-size, size), uniform(-size, size)}; }
    Vec3 direction() {
        for (;;)
            if (const Vec3 v = in_box(1); glm::length(v) <= 1 && glm::length(v) > 0.1)
                return v / std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    }
    /// Near, inside, far, along axes and planes, and just about touching.
    Ray next(const Primitive& kind) {
        switch (random_() % 8) {
        case 0:
            return {in_box(1), direction()};
        case 1:
            return {in_box(3), direction()};
        case 2:
            return from(in_box(1.2), std::exp(uniform(0, 8)) * direction());
        case 3: {
            Ray ray = from(in_box(1.1), uniform(0, 3) * direction());
            ray.origin.y = ray.direction.y = 0;
            return ray;
        }
        case 4: {
            Vec3 along(0.0);
            along[static_cast<int>(random_() % 3)] = random_() % 2 ? 1 : -1;
            return from(in_box(1.1), 3.0 * along);
        }
        case 5:
            return touching(kind, 0);
        case 6:
            return touching(kind, std::exp(uniform(-20, -2)));
        default:
            return from(in_box(1.1), 2.0 * direction());
        }
    }

  private:
    static Ray from(Vec3 target, Vec3 back) {
        const double size = std::max({std::abs(back.x), std::abs(back.y), std::abs(back.z), 1e-3});
        return {target + back, -back / size};
    }
    /// In the tangent plane of a point of the surface, moved in by `depth`.
    Ray touching(const Primitive& kind, double depth) {
        const Vec3 start = in_box(1);
        const auto hit = hit_of(kind, {start, direction()});
        if (!hit) return {start, direction()};
        const Vec3 across = glm::cross(hit->second.normal, direction());
        return from(hit->first - depth * hit->second.normal, uniform(1, 4) * across);
    }
    static std::optional<std::pair<Vec3, PrimitiveHit>> hit_of(const Primitive& kind, const Ray& ray) {
        PrimitiveHit hit;
        if (!intersect(kind, ray, {}, hit)) return {};
        return std::pair(ray(hit.t), hit);
    }

    std::mt19937_64 random_;
};

/// Expects `inside` of the ray between two crossings, except next to the surface.
void expect_uncrossed(const Primitive& kind, const Ray& ray, double least, double most, bool inside,
                      int samples) {
    for (int i = 1; i < samples; ++i) {
        const double g = outside(kind, ray(least + (most - least) * i / samples));
        ASSERT_LT(inside ? g : -g, 1e-9) << "a crossing is missing, " << i << " of " << samples;
    }
}

/// Follows a ray through all of its crossings.
int follow(const Primitive& kind, const Ray& ray) {
    const double middle = -glm::dot(ray.origin, ray.direction) / glm::dot(ray.direction, ray.direction);
    const double reach = 2 / glm::length(ray.direction), far = std::max(middle + reach, 0.0);
    double last = 0, start = std::max(0.0, middle - reach);
    int crossings = 0;
    for (PrimitiveHit hit; intersect(kind, ray, {last, INFINITY}, hit); ++crossings) {
        const Vec3 p = ray(hit.t);
        EXPECT_NEAR(outside(kind, p), 0, 2e-15 + 4e-16 * glm::length(ray.origin));
        EXPECT_NEAR(glm::length(hit.normal), 1, 1e-14);
        const double size = glm::length(ray.direction), facing = glm::dot(hit.normal, ray.direction) / size;
        if (!near_edge(kind, p)) {
            EXPECT_LT(glm::length(gradient(kind, p) - hit.normal), 1e-5);
        }
        if (std::abs(facing) > 1e-5) // in, where the normal is against the ray
            expect_uncrossed(kind, ray, start, hit.t, facing > 0, 40);
        last = start = hit.t + 1e-9 * std::max(1.0, hit.t * 1e-3);
        if (crossings > 6 || testing::Test::HasFailure()) return crossings;
    }
    expect_uncrossed(kind, ray, start, far, false, 60);
    return crossings;
}

TEST(IntersectProperty, EveryCrossingIsFoundOnTheSurface) {
    for (const Primitive& kind : solids) {
        RandomRays rays(3);
        int crossings = 0;
        const int count = kind == PrimitiveKind::torus ? 40000 : 8000;
        for (int i = 0; i < count; ++i) {
            const Ray ray = rays.next(kind);
            SCOPED_TRACE(testing::Message()
                         << name_of(kind) << " ray " << i << ": " << ray.origin.x << ' ' << ray.origin.y
                         << ' ' << ray.origin.z << " + t " << ray.direction.x << ' ' << ray.direction.y << ' '
                         << ray.direction.z);
            crossings += follow(kind, ray);
            if (HasFailure()) return;
        }
        EXPECT_GT(crossings, count / 2) << name_of(kind);
    }
}

TEST(IntersectProperty, FlatOnesAreMetWhereTheirPlaneIs) {
    RandomRays rays(4);
    int met = 0;
    for (int i = 0; i < 40000; ++i) {
        const Ray ray = rays.next(PrimitiveKind::sphere);
        PrimitiveHit hit;
        if (ray.direction.y != 0) {
            const bool ahead = ray.origin.y * ray.direction.y < 0;
            ASSERT_EQ(intersect(PrimitiveKind::plane, ray, {}, hit), ahead);
            if (ahead) {
                ASSERT_NEAR(ray(hit.t).y, 0, 1e-15 * std::max(1.0, std::abs(ray.origin.y)));
            }
        }
        if (std::abs(ray.direction.z) < 1e-6) continue;
        const double t = -ray.origin.z / ray.direction.z;
        const Vec3 p = ray(t);
        // Distances within, from the three sides.
        const double within = std::min({p.y + 0.5, 0.5 - 0.5 * p.y - 0.75 / std::sqrt(0.75) * p.x,
                                        0.5 - 0.5 * p.y + 0.75 / std::sqrt(0.75) * p.x});
        if (std::abs(within) < 1e-9 || std::abs(t) < 1e-12) continue;
        ASSERT_EQ(intersect(PrimitiveKind::triangle, ray, {}, hit), within > 0 && t > 0) << i;
        if (within > 0 && t > 0) {
            ASSERT_NEAR(hit.t, t, 1e-15 * t);
            ++met;
        }
    }
    EXPECT_GT(met, 4000);
}

/// By Moeller and Trumbore.
std::optional<double> meet_mesh(const TessellatedPrimitive& mesh, const Ray& ray) {
    std::optional<double> first;
    for (const auto& corners : mesh.triangles) {
        const Vec3 a = mesh.vertices[corners[0]], ab = mesh.vertices[corners[1]] - a,
                   ac = mesh.vertices[corners[2]] - a, normal = glm::cross(ab, ac), from = ray.origin - a;
        const double volume = -glm::dot(ray.direction, normal);
        const Vec3 moment = glm::cross(from, ray.direction);
        const double u = glm::dot(ac, moment) / volume, v = -glm::dot(ab, moment) / volume;
        const double t = glm::dot(from, normal) / volume;
        if (!(u >= 0 && v >= 0 && u + v <= 1 && t > 0)) continue;
        if (!first || t < *first) first = t;
    }
    return first;
}

TEST(IntersectProperty, AgreesWithTheMeshes) {
    for (const Primitive& kind : std::initializer_list<Primitive>{
             PrimitiveKind::triangle, PrimitiveKind::sphere, PrimitiveKind::cube, PrimitiveKind::cylinder,
             PrimitiveKind::cone, PrimitiveKind::torus, tapered(0.125), tapered(0.75)}) {
        const TessellatedPrimitive& mesh = tessellated(kind, max_fineness(kind));
        const double error = tessellation_error(kind, max_fineness(kind));
        RandomRays rays(9);
        int compared = 0;
        for (int i = 0; i < 40; ++i) {
            const Vec3 target = rays.in_box(0.7), way = rays.direction();
            const Ray ray{target - 3.0 * way, way};
            const auto expected = meet_mesh(mesh, ray);
            PrimitiveHit hit;
            const bool met = intersect(kind, ray, {}, hit);
            const double facing = met ? std::abs(glm::dot(hit.normal, glm::normalize(way))) : 0;
            if (met && facing < 0.2) continue;
            ASSERT_EQ(met, expected.has_value()) << name_of(kind) << ' ' << i;
            if (!met) continue;
            // Across the surface; the ray crosses it at a slant.
            ASSERT_LE(std::abs(hit.t - *expected) * glm::length(way) * facing, 1.1 * error + 1e-13)
                << name_of(kind) << ' ' << i;
            ++compared;
        }
        EXPECT_GT(compared, 5) << name_of(kind);
    }
}

} // namespace
} // namespace graftal
