#pragma once

// Short vectors of the compiler's own kind (GCC and Clang): operations on them become AVX2 in functions that
// ask for it and pairs of SSE2 operations elsewhere, with the same results to the last bit.

#include <cstdint>

#include "compiler/support/affine.h"

namespace graftal {

using Double4 = double __attribute__((vector_size(32), aligned(32)));
using Float4 = float __attribute__((vector_size(16), aligned(16)));
using Float8 = float __attribute__((vector_size(32), aligned(32)));
using Int8 = std::int32_t __attribute__((vector_size(32), aligned(32)));

/// Three lanes and a 0. Inlined everywhere: how vectors are passed depends on the instructions.
inline __attribute__((always_inline)) Double4 lanes_of(const Vec3& v) {
    return Double4{v.x, v.y, v.z, 0};
}

/// An affine map by columns; the last lanes are 0.
struct LaneMap {
    Double4 column[3];
    Double4 translation;

    LaneMap() : LaneMap(Affine{}) {}
    explicit LaneMap(const Affine& a)
        : column{lanes_of(a.linear[0]), lanes_of(a.linear[1]), lanes_of(a.linear[2])},
          translation(lanes_of(a.translation)) {}

    Affine affine() const {
        Affine a;
        for (int i = 0; i < 3; ++i) {
            a.linear[i] = {column[i][0], column[i][1], column[i][2]};
            a.translation[i] = translation[i];
        }
        return a;
    }
};

} // namespace graftal
