#pragma once

// Words of formulas that are C++ and GLSL at once (*.glsl): a file that includes such a text puts it into the
// namespace `formulas`. There, `real` is double, vectors are GLM's of doubles, and functions are GLM's. The
// kernel of GPUs defines the same words in GLSL (runtime/gpu/kernel/picture.comp).

#include <cmath>
#include <cstdint>
#include <numbers>

#include <glm/glm.hpp>

/// A function; a number from a literal; parameters that are written, and read as well.
#define FORMULA inline
#define REAL(number) double(number)
#define OUT(Type) Type&
#define INOUT(Type) Type&

namespace graftal::formulas {

using namespace glm;
using real = double;
using vec2 = glm::dvec2;
using vec3 = glm::dvec3;
using uint = std::uint32_t;
inline constexpr double PI = std::numbers::pi;

/// Both of an angle in radians of less than 1e15, within 1e-9: without calls, so that a compiler takes
/// several at a time. Taylor's series of the sine up to x^13, on a quarter of a turn to either side.
inline void cosine_and_sine(double angle, double& cosine, double& sine) {
    constexpr double to_whole = 6755399441055744.0; // adding it rounds to whole numbers
    const double turns = angle * (0.5 / PI);
    const double turn = turns - ((turns + to_whole) - to_whole), size = std::abs(turn);
    const auto sine_of = [](double x) {
        const double xx = x * x;
        return x * (1 + xx * (-1 / 6.0 +
                              xx * (1 / 120.0 + xx * (-1 / 5040.0 + xx * (1 / 362880.0 +
                                                                          xx * (-1 / 39916800.0 +
                                                                                xx * (1 / 6227020800.0)))))));
    };
    cosine = sine_of(2 * PI * (0.25 - size));
    // Beyond a quarter it is that of the rest of the half turn.
    sine = sine_of(2 * PI * std::copysign(0.25 - std::abs(size - 0.25), turn));
}

inline double hypotenuse(double x, double y) {
    return std::hypot(x, y);
}

} // namespace graftal::formulas
