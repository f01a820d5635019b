#include "runtime/trace/shade/patterns.h"

#include <glm/geometric.hpp>

#include "runtime/trace/shade/formulas.h"

namespace graftal {

namespace formulas {

namespace {

void pattern_wave(int level, int number, vec3& direction, double& phase) {
    const auto of_table = static_cast<std::size_t>(level & (pattern_levels - 1));
    const PatternWave& wave = pattern_table()[of_table][static_cast<std::size_t>(number)];
    direction = wave.direction;
    phase = wave.phase;
}

#include "runtime/trace/shade/patterns.glsl"

} // namespace

} // namespace formulas

PatternValue pattern_at(const SolidPattern& pattern, double size, double footprint, Vec3 world) {
    PatternValue sum;
    for (const PatternLayer& layer : pattern.layers) {
        const double wavelength = wavelength_of(layer, size);
        Vec3 slope;
        double faded = 0;
        const double value =
            formulas::pattern_layer(static_cast<int>(layer.kind), static_cast<int>(layer.octaves), layer.warp,
                                    wavelength, footprint, layer.stretch, world, slope, faded);
        sum.value = glm::mix(sum.value, value, layer.share);
        const double depth = relief_depth * wavelength;
        sum.relief = glm::mix(sum.relief, depth * slope, layer.share);
        sum.faded = (1 - layer.share) * (1 - layer.share) * sum.faded +
                    layer.share * layer.share * depth * depth * faded;
    }
    return sum;
}

Vec3 bumped(Vec3 normal, Vec3 relief, double bump, Vec3 ray_direction) {
    return formulas::pattern_normal(normal, bump * relief, ray_direction);
}

void show_relief(const PatternValue& at, double bump, Vec3 ray_direction, SurfaceHit& hit) {
    if (glm::dot(hit.normal, ray_direction) > 0) hit.normal = -hit.normal;
    hit.normal = bumped(hit.normal, at.relief, bump, ray_direction);
    hit.faded = bump * bump * at.faded;
}

} // namespace graftal
