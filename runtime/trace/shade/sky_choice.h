#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/vec2.hpp>

#include "compiler/support/affine.h"
#include "compiler/support/axes_across.h"

namespace graftal {

/// A unit vector at that cosine and turn about a unit vector.
inline Vec3 from_pole(Vec3 pole, double along, double turn) {
    const auto [a, b] = axes_across(pole);
    const double radius = std::sqrt(std::max(0.0, 1 - along * along));
    return along * pole + radius * (std::cos(turn) * a + std::sin(turn) * b);
}

/// A direction in the half about a unit normal: its density is the cosine over pi.
inline Vec3 cosine_direction(Vec3 normal, glm::dvec2 place) {
    return from_pole(normal, std::sqrt(1 - place.x), 2 * std::numbers::pi * place.y);
}

/// Its density is 1 / (2 pi).
inline Vec3 even_direction(Vec3 normal, glm::dvec2 place) {
    return from_pole(normal, 1 - place.x, 2 * std::numbers::pi * place.y);
}

/// A surface's choice of a direction towards the sky, by the cosine: in the half that it faces, or in the
/// other if light comes through. If the surface shines, half of the choices are even.
struct SkyChoice {
    double front_chance = 1;
    bool shines = false;

    Vec3 direction(Vec3 normal, glm::dvec2 place) const {
        const bool behind = place.x >= front_chance;
        place.x = behind ? (place.x - front_chance) / (1 - front_chance) : place.x / front_chance;
        if (behind) return cosine_direction(-normal, place);
        const bool even = shines && place.x < 0.5;
        if (shines) place.x = even ? 2 * place.x : 2 * place.x - 1;
        return even ? even_direction(normal, place) : cosine_direction(normal, place);
    }

    /// A steradian, times pi. `along`: the cosine with the normal.
    double density_pi(double along) const {
        if (along < 0) return (1 - front_chance) * -along;
        return front_chance * (shines ? 0.5 * along + 0.25 : along);
    }
};

} // namespace graftal
