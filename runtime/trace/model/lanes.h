#pragma once

// Short vectors of the compiler's own kind (GCC and Clang): operations on them become AVX2 in functions that
// ask for it and pairs of SSE2 operations elsewhere, with the same results to the last bit.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "compiler/support/affine.h"

namespace graftal {

using Double4 = double __attribute__((vector_size(32), aligned(32)));
using Float4 = float __attribute__((vector_size(16), aligned(16)));
using Float8 = float __attribute__((vector_size(32), aligned(32)));
using Byte8 = std::uint8_t __attribute__((vector_size(8), aligned(8)));
// Results of comparing: GCC and Clang do not agree on their elements.
using Long4 __attribute__((aligned(32))) = decltype(Double4{} < Double4{});
using Int4 __attribute__((aligned(16))) = decltype(Float4{} < Float4{});
using Int8 __attribute__((aligned(32))) = decltype(Float8{} < Float8{});

/// For functions that take or give vectors: how these are passed depends on the instructions.
#define GRAFTAL_INLINE inline __attribute__((always_inline))
/// GRAFTAL_INLINE for a lambda, after its parameters: Clang called one for SSE2 from AVX2, and four lanes
/// were lost.
#define GRAFTAL_INLINED_LAMBDA __attribute__((always_inline))

/// Three lanes and a 0.
GRAFTAL_INLINE Double4 lanes_of(const Vec3& v) {
    return Double4{v.x, v.y, v.z, 0};
}

/// A number of each of eight rays.
struct Double8 {
    Double4 half[2];
};

GRAFTAL_INLINE Float8 floats_of(const Double8& lanes) {
    const Float4 low = __builtin_convertvector(lanes.half[0], Float4),
                 high = __builtin_convertvector(lanes.half[1], Float4);
    return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
}

/// The first four lanes, or the others.
GRAFTAL_INLINE Double4 doubles_of(const Float8& lanes, int half) {
    const Float4 four = half == 0 ? __builtin_shufflevector(lanes, lanes, 0, 1, 2, 3)
                                  : __builtin_shufflevector(lanes, lanes, 4, 5, 6, 7);
    return __builtin_convertvector(four, Double4);
}

/// An affine map by columns; the last lanes are 0.
struct LaneMap {
    Double4 translation; ///< first, for maps of which nothing else is asked
    Double4 column[3];

    LaneMap() : LaneMap(Affine{}) {}
    explicit LaneMap(const Affine& a)
        : translation(lanes_of(a.translation)), column{lanes_of(a.linear[0]), lanes_of(a.linear[1]),
                                                       lanes_of(a.linear[2])} {}

    Affine affine() const {
        Affine a;
        for (int i = 0; i < 3; ++i) {
            a.linear[i] = {column[i][0], column[i][1], column[i][2]};
            a.translation[i] = translation[i];
        }
        return a;
    }
};

/// Spreads a number by an operation with a scalar, which compilers do at once: they insert a list of lanes
/// one by one.
GRAFTAL_INLINE Double4 splat(double x) {
    return x - Double4{};
}

GRAFTAL_INLINE Double4 direction_through(const LaneMap& map, const Double4& v) {
    return map.column[0] * splat(v[0]) + map.column[1] * splat(v[1]) + map.column[2] * splat(v[2]);
}

GRAFTAL_INLINE Double4 point_through(const LaneMap& map, const Double4& p) {
    return direction_through(map, p) + map.translation;
}

GRAFTAL_INLINE void compose(const LaneMap& a, const LaneMap& b, LaneMap& product) {
    for (int i = 0; i < 3; ++i)
        product.column[i] = direction_through(a, b.column[i]);
    product.translation = point_through(a, b.translation);
}

GRAFTAL_INLINE double largest_component(const Double4& v) {
    return std::max(std::max(std::abs(v[0]), std::abs(v[1])), std::abs(v[2]));
}

/// The largest power of two that is not above a positive number. Multiplying by powers of two rounds nothing.
GRAFTAL_INLINE double power_below(double x) {
    return std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) & 0x7ff0'0000'0000'0000);
}

/// 1 divided by a power of two; faster than a quotient.
GRAFTAL_INLINE double inverse_power(double power) {
    return std::bit_cast<double>(0x7fe0'0000'0000'0000 - std::bit_cast<std::uint64_t>(power));
}

// std::bit_cast of vectors is a function without AVX2 where it is not inlined: it hands them over in other
// registers. A cast between vectors keeps the bits as well.
GRAFTAL_INLINE Double4 power_below(const Double4& x) {
    return reinterpret_cast<Double4>(reinterpret_cast<Long4>(x) & 0x7ff0'0000'0000'0000);
}

GRAFTAL_INLINE Double4 inverse_power(const Double4& power) {
    return reinterpret_cast<Double4>(0x7fe0'0000'0000'0000 - reinterpret_cast<Long4>(power));
}

GRAFTAL_INLINE Vec3 vec3_of(const Double4& v) {
    return {v[0], v[1], v[2]};
}

GRAFTAL_INLINE Mat3 linear_of(const LaneMap& map) {
    return {vec3_of(map.column[0]), vec3_of(map.column[1]), vec3_of(map.column[2])};
}

GRAFTAL_INLINE Double4 size_of(const Double4& x) {
    return x < 0 ? -x : x;
}

/// largest_component() of four vectors.
GRAFTAL_INLINE Double4 largest_of(const Double4& x, const Double4& y, const Double4& z) {
    const Double4 a = size_of(x), b = size_of(y), c = size_of(z);
    const Double4 ab = a < b ? b : a;
    return ab < c ? c : ab;
}

/// An axis of direction_through(), of four vectors.
GRAFTAL_INLINE Double4 through(const LaneMap& map, const Double4& x, const Double4& y, const Double4& z,
                               int axis) {
    return splat(map.column[0][axis]) * x + splat(map.column[1][axis]) * y + splat(map.column[2][axis]) * z;
}

GRAFTAL_INLINE Float8 lesser(const Float8& a, const Float8& b) {
    return a < b ? a : b;
}

GRAFTAL_INLINE Float8 greater(const Float8& a, const Float8& b) {
    return a > b ? a : b;
}

} // namespace graftal
