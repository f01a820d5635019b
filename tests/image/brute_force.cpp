#include "tests/image/brute_force.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

namespace graftal {

namespace {

/// One crossing, in the frame of the primitive.
struct Crossing {
    double t;
    Vec3 normal;
};

void cross_sphere(const Ray& ray, std::vector<Crossing>& crossings) {
    const double a = glm::dot(ray.direction, ray.direction);
    const double b = glm::dot(ray.origin, ray.direction);
    const Vec3 nearest = ray(-b / a);
    const double rest = 1 - glm::dot(nearest, nearest);
    if (rest <= 0) return;
    const double half = std::sqrt(rest / a);
    for (const double t : {-b / a - half, -b / a + half})
        crossings.push_back({t, ray(t)});
}

void cross_cube(const Ray& ray, std::vector<Crossing>& crossings) {
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
            const double t = (side - ray.origin[axis]) / ray.direction[axis];
            const Vec3 p = ray(t);
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            if (!std::isfinite(t) || std::abs(p[u]) > 1 || std::abs(p[v]) > 1) continue;
            Vec3 normal(0.0);
            normal[axis] = side;
            crossings.push_back({t, normal});
        }
}

void cross_plane(const Ray& ray, std::vector<Crossing>& crossings) {
    const double t = -ray.origin.y / ray.direction.y;
    if (std::isfinite(t)) crossings.push_back({t, {0, 1, 0}});
}

void cross_triangle(const Ray& ray, std::vector<Crossing>& crossings) {
    const double t = -ray.origin.z / ray.direction.z;
    if (!std::isfinite(t)) return;
    const Vec3 p = ray(t);
    if (p.y >= -0.5 && std::sqrt(3.0) * std::abs(p.x) + p.y <= 1) crossings.push_back({t, {0, 0, 1}});
}

std::vector<Crossing> crossings_of(const Primitive& kind, const Ray& ray) {
    std::vector<Crossing> crossings;
    if (kind == PrimitiveKind::sphere) cross_sphere(ray, crossings);
    if (kind == PrimitiveKind::cube) cross_cube(ray, crossings);
    if (kind == PrimitiveKind::plane) cross_plane(ray, crossings);
    if (kind == PrimitiveKind::triangle) cross_triangle(ray, crossings);
    return crossings;
}

bool known(const Primitive& kind) {
    return kind == PrimitiveKind::sphere || kind == PrimitiveKind::cube || kind == PrimitiveKind::plane ||
           kind == PrimitiveKind::triangle;
}

} // namespace

BruteForce::BruteForce(const Cut& cut) {
    for (const PlacementGroup& group : cut.groups)
        for (const Placement& placement : group.placements) {
            const auto* kind = std::get_if<Primitive>(&cut.bodies[placement.body].shape);
            EXPECT_TRUE(kind && known(*kind)) << "not for such bodies";
            const Palette& palette = cut.palettes[group.palette];
            EXPECT_EQ(palette.size(), 1u);
            if (kind)
                parts_.push_back({*kind, inverse(placement.world_from_body), group.tint.over(palette[0]),
                                  &group.material});
        }
}

bool BruteForce::closest(const Ray& ray, const RayRange& range, SurfaceHit& hit) {
    double most = range.most;
    for (const Part& part : parts_) {
        const Ray local{part.part_from_world(ray.origin), part.part_from_world.linear * ray.direction};
        for (const Crossing& crossing : crossings_of(part.kind, local)) {
            if (!(range.least < crossing.t && crossing.t < most)) continue;
            most = crossing.t;
            const Vec3 normal = glm::transpose(part.part_from_world.linear) * crossing.normal;
            hit = {crossing.t, glm::normalize(normal), part.rgb, part.material};
        }
    }
    return most < range.most;
}

bool BruteForce::meets_any(const Ray& ray, const RayRange& range) {
    SurfaceHit hit;
    return closest(ray, range, hit);
}

} // namespace graftal
