#include "compiler/graph/pattern.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace graftal {

std::span<const std::string_view> pattern_words() {
    static constexpr std::string_view words[] = {"noise", "ridges", "cells", "bands", "rings"};
    return words;
}

namespace {

/// Numbers in [0, 1) by additive recurrences of irrational numbers.
double part(double number, double step) {
    return number * step - std::floor(number * step);
}

Vec3 direction_of(double number) {
    const double z = 2 * part(number, 0.7548776662466927) - 1, across = std::sqrt(1 - z * z),
                 turn = 2 * std::numbers::pi * part(number, 0.5698402909980532);
    return {across * std::cos(turn), z, across * std::sin(turn)};
}

/// Directions that lie about evenly in half of all, turned. Their lengths differ, for waves of one length
/// make crystals.
std::array<Vec3, pattern_noise_waves> spread_directions(double number) {
    const Vec3 pole = direction_of(number), other = direction_of(number + 0.5);
    const Vec3 a =
        glm::normalize(glm::cross(pole, std::abs(glm::dot(pole, other)) < 0.9 ? other : Vec3(1, 0, 0)));
    const Mat3 turned(a, pole, glm::cross(a, pole));
    std::array<Vec3, pattern_noise_waves> directions;
    for (int i = 0; i < pattern_noise_waves; ++i) {
        const double z = (i + 0.5) / pattern_noise_waves, across = std::sqrt(1 - z * z),
                     turn = 2 * std::numbers::pi * part(i, std::numbers::phi);
        const double length = std::exp2(0.9 * (part(number + i, std::numbers::phi) - 0.5));
        directions[static_cast<std::size_t>(i)] =
            length * (turned * Vec3(across * std::cos(turn), z, across * std::sin(turn)));
    }
    return directions;
}

} // namespace

const std::array<std::array<PatternWave, pattern_waves>, pattern_levels>& pattern_table() {
    static const auto table = [] {
        std::array<std::array<PatternWave, pattern_waves>, pattern_levels> made;
        double number = 1;
        for (auto& level : made) {
            const auto spread = spread_directions(number);
            for (std::size_t i = 0; i < level.size(); ++i, ++number)
                level[i] = {i < spread.size() ? spread[i] : direction_of(number),
                            2 * std::numbers::pi * part(number, std::numbers::phi)};
        }
        return made;
    }();
    return table;
}

unsigned SolidPattern::waves() const {
    constexpr unsigned of_warp = 18;
    unsigned sum = 0;
    for (const PatternLayer& layer : layers) {
        const unsigned of_octave = layer.kind == PatternKind::noise || layer.kind == PatternKind::ridges ? 8
                                   : layer.kind == PatternKind::cells                                    ? 4
                                                                                                         : 1;
        sum += of_octave * (layer.octaves + 1) + (layer.warp != 0 ? of_warp : 0);
    }
    return sum;
}

double pattern_size(double part_size) {
    return std::exp2(0.5 * std::round(2 * std::log2(part_size)));
}

double wavelength_of(const PatternLayer& layer, double size) {
    return layer.of_world ? layer.scale : layer.scale * size;
}

Rgb pattern_colour(const SolidPattern& pattern, Rgb rgb, double value) {
    return value < 0.5 ? glm::mix(pattern.low, rgb, 2 * value) : glm::mix(rgb, pattern.high, 2 * value - 1);
}

} // namespace graftal
