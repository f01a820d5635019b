#pragma once

// A scene of balls and endless walls, for tests of light.

#include <cmath>
#include <cstdint>
#include <vector>

#include <glm/geometric.hpp>

#include "runtime/trace/shade/shade.h"

namespace graftal {

struct LitBall {
    Vec3 centre;
    double radius;
    Rgb rgb;
    Material material;
};

/// The plane of the points p with dot(p, normal) = offset.
struct Wall {
    Vec3 normal;
    double offset;
    Rgb rgb;
    Material material;
};

class Scene : public Surfaces {
  public:
    std::vector<LitBall> balls;
    std::vector<Wall> walls;
    int shadow_rays = 0;

    bool closest(const Ray& ray, const RayRange& range, SurfaceHit& hit) override {
        RayRange rest = range;
        const auto meet = [&](double t, Vec3 normal, Rgb rgb, const Material& material) {
            if (!(rest.least < t && t < rest.most)) return;
            rest.most = t;
            hit = {t, normal, rgb, &material};
        };
        for (const LitBall& ball : balls) {
            const Vec3 way = ray.origin - ball.centre;
            const double b = glm::dot(way, ray.direction);
            const double root = std::sqrt(b * b - glm::dot(way, way) + ball.radius * ball.radius);
            for (const double t : {-b - root, -b + root})
                meet(t, (ray(t) - ball.centre) / ball.radius, ball.rgb, ball.material);
        }
        for (const Wall& wall : walls)
            meet((wall.offset - glm::dot(ray.origin, wall.normal)) / glm::dot(ray.direction, wall.normal),
                 wall.normal, wall.rgb, wall.material);
        return rest.most < range.most;
    }

    bool meets_any(const Ray& ray, const RayRange& range) override {
        ++shadow_rays;
        SurfaceHit hit;
        return closest(ray, range, hit);
    }
};

/// Ten units in front of the picture plane, black behind.
inline View black_view() {
    View view;
    view.size = {100, 100};
    view.camera.location = {0, 0, 10};
    view.sky.zenith = view.sky.horizon = Rgb(0.0);
    return view;
}

/// The same in a light that comes from all directions alike, and is seen.
inline View in_furnace(Rgb light, unsigned bounces = 0) {
    View view = black_view();
    view.sky_light = SkyLight{.zenith = light, .horizon = light, .below = light, .bounces = bounces};
    view.shows_sky_light = true;
    return view;
}

inline Rgb mean_light(Shader& shader, const Ray& ray, std::uint32_t samples) {
    Rgb sum(0.0);
    for (std::uint32_t i = 0; i < samples; ++i) {
        SampleStream random(0, i);
        sum += shader.radiance(ray, random);
    }
    return sum / static_cast<double>(samples);
}

inline const Ray ahead{{0, 0, 10}, {0, 0, -1}};
inline const Material matt{.ambient = 0, .diffuse = 1, .specular = 0};

} // namespace graftal
