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

inline double hypotenuse(double x, double y) {
    return std::hypot(x, y);
}

} // namespace graftal::formulas
