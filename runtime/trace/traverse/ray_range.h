#pragma once

// Where a ray is in boxes and goes by parts, as the traversal asks it of every part.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <glm/geometric.hpp>

#include "runtime/trace/traverse/traversal.h"

namespace graftal {

/// Most clear places of one primitive's picture that a ray goes through. A torus is crossed four times, a
/// mesh any number of times.
inline constexpr int most_crossings = 256;
/// Allows for the rounding of what is a little more than enough.
inline constexpr double surely_more = 1 - 1e-6;

/// Attribute of functions for AVX2, if the machine may have it.
#if defined(__x86_64__)
#define GRAFTAL_AVX2 __attribute__((target("avx2")))
inline constexpr bool knows_avx2 = true; ///< instantiates the kernels for it
#else
#define GRAFTAL_AVX2
inline constexpr bool knows_avx2 = false;
#endif

/// One bit for each lane that is true.
template<Instructions instructions> GRAFTAL_INLINE std::uint32_t bits_of(const Int8& lanes) {
#if defined(__x86_64__) && !defined(__clang__)
    if constexpr (instructions == Instructions::avx2) {
        std::uint32_t bits;
        // An intrinsic could not be inlined from here: only the caller is compiled for AVX2. Clang looks at
        // the operands before it inlines.
        __asm__("vmovmskps %1, %0" : "=r"(bits) : "x"(lanes));
        return bits;
    }
#endif
    std::uint32_t bits = 0;
    for (int lane = 0; lane < 8; ++lane)
        bits |= static_cast<std::uint32_t>(lanes[lane] & 1) << lane;
    return bits;
}

template<Instructions instructions> GRAFTAL_INLINE std::uint32_t bits_of(const Long4& lanes) {
#if defined(__x86_64__) && !defined(__clang__)
    if constexpr (instructions == Instructions::avx2) {
        std::uint32_t bits;
        __asm__("vmovmskpd %1, %0" : "=r"(bits) : "x"(lanes));
        return bits;
    }
#endif
    std::uint32_t bits = 0;
    for (int lane = 0; lane < 4; ++lane)
        bits |= static_cast<std::uint32_t>(lanes[lane] & 1) << lane;
    return bits;
}

/// One number in all lanes.
template<Instructions instructions> GRAFTAL_INLINE Float8 spread(float x) {
#if defined(__x86_64__) && !defined(__clang__)
    if constexpr (instructions == Instructions::avx2) {
        Float8 lanes;
        // GCC inserts them one by one.
        __asm__("vbroadcastss %1, %0" : "=x"(lanes) : "xm"(x));
        return lanes;
    }
#endif
    return x - Float8{};
}

/// The lanes that have a bit, and a number for the others.
template<Instructions instructions>
GRAFTAL_INLINE Float8 lanes_in(const Float8& lanes, std::uint32_t mask, float other) {
    constexpr Int8 bit = {1, 2, 4, 8, 16, 32, 64, 128};
    const Int8 used = (static_cast<std::int32_t>(mask) & bit) != 0;
    return used ? lanes : spread<instructions>(other);
}

/// The greatest of the lanes that have a bit.
template<Instructions instructions> GRAFTAL_INLINE float greatest(const Float8& lanes, std::uint32_t mask) {
    Float8 all = lanes_in<instructions>(lanes, mask, -std::numeric_limits<float>::infinity());
    all = greater(all, __builtin_shufflevector(all, all, 4, 5, 6, 7, 0, 1, 2, 3));
    all = greater(all, __builtin_shufflevector(all, all, 2, 3, 0, 1, 6, 7, 4, 5));
    all = greater(all, __builtin_shufflevector(all, all, 1, 0, 3, 2, 5, 4, 7, 6));
    return all[0];
}

template<Instructions instructions> GRAFTAL_INLINE float smallest(const Float8& lanes, std::uint32_t mask) {
    Float8 all = lanes_in<instructions>(lanes, mask, std::numeric_limits<float>::infinity());
    all = lesser(all, __builtin_shufflevector(all, all, 4, 5, 6, 7, 0, 1, 2, 3));
    all = lesser(all, __builtin_shufflevector(all, all, 2, 3, 0, 1, 6, 7, 4, 5));
    all = lesser(all, __builtin_shufflevector(all, all, 1, 0, 3, 2, 5, 4, 7, 6));
    return all[0];
}

/// A number that is no greater.
inline float float_below(double x) {
    const auto rounded = static_cast<float>(x);
    return static_cast<double>(rounded) > x ? std::nextafter(rounded, -std::numeric_limits<float>::infinity())
                                            : rounded;
}

/// Where it is 0 something small: far beyond all boxes, but a number, and 0 times it is 0.
GRAFTAL_INLINE Float4 never_zero(const Float4& direction) {
    constexpr Float4 least = {1e-18f, 1e-18f, 1e-18f, 1e-18f};
    const Float4 magnitude = direction < 0 ? -direction : direction;
    return magnitude > least ? direction : least;
}

/// The range of t in which a ray is within a box; empty where least > most.
GRAFTAL_INLINE RayRange range_in(const Box& box, const Ray& ray, RayRange range) {
    for (int axis = 0; axis < 3; ++axis) {
        const double d = ray.direction[axis];
        if (d == 0) {
            if (ray.origin[axis] < box.min[axis] || ray.origin[axis] > box.max[axis]) return {1, 0};
            continue;
        }
        const double inverse = 1 / d;
        const double a = (box.min[axis] - ray.origin[axis]) * inverse;
        const double b = (box.max[axis] - ray.origin[axis]) * inverse;
        range.least = std::max(range.least, std::min(a, b));
        range.most = std::min(range.most, std::max(a, b));
    }
    return range;
}

/// The box, larger by what rounding and widened parts may need.
inline Box enlarged(const Box& box, Vec3 margin) {
    const Vec3 more = 1e-9 * box.size() + margin;
    return {box.min - more, box.max + more};
}

// Most met boxes are met beside their part. To tell that is faster than to find where a ray meets the part.
inline constexpr double surely_beside = 1 + 1e-9;

/// Whether a ray goes by a line at this distance or more, for sure.
GRAFTAL_INLINE bool passes_line(Vec3 direction, Vec3 from_line, Vec3 along, double distance) {
    const Vec3 upright = glm::cross(direction, along);
    const double apart = glm::dot(from_line, upright);
    return apart * apart > surely_beside * distance * distance * glm::dot(upright, upright);
}

GRAFTAL_INLINE bool passes_point(Vec3 direction, Vec3 from_point, double distance) {
    const Vec3 moment = glm::cross(direction, from_point);
    return glm::dot(moment, moment) > surely_beside * distance * distance * glm::dot(direction, direction);
}

} // namespace graftal
