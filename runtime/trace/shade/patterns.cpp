#include "runtime/trace/shade/patterns.h"

#include <cmath>

#include "runtime/trace/shade/formulas.h"

namespace graftal {

namespace formulas {

namespace {

void pattern_wave(int level, int number, vec3& direction, double& phase) {
    const int of_table = ((level % pattern_levels) + pattern_levels) % pattern_levels;
    const PatternWave& wave =
        pattern_table()[static_cast<std::size_t>(of_table)][static_cast<std::size_t>(number)];
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
        const double value =
            formulas::pattern_layer(static_cast<int>(layer.kind), static_cast<int>(layer.octaves), layer.warp,
                                    wavelength, footprint, world / layer.stretch, slope);
        sum.value = glm::mix(sum.value, value, layer.share);
        sum.relief = glm::mix(sum.relief, relief_depth * wavelength * (slope / layer.stretch), layer.share);
    }
    return sum;
}

Vec3 bumped(Vec3 normal, Vec3 relief, double bump, Vec3 ray_direction) {
    constexpr double least = 0.02; // of what is seen
    Vec3 tilted = glm::normalize(normal - bump * relief);
    const double seen = -glm::dot(tilted, ray_direction);
    if (seen < least) tilted = glm::normalize(tilted + (seen - least) * ray_direction);
    return std::isfinite(tilted.x) ? tilted : normal;
}

} // namespace graftal
