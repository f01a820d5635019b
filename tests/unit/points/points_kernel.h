#pragma once

// The kernel of random points as C++: GLM has the words of GLSL, and the arrays are those of a FlatGame.

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>
#include <glm/integer.hpp>

#include "compiler/chaos/flat_game.h"

#define INOUT(Type) Type&

namespace graftal::points_kernel {

using namespace glm;
using uint = std::uint32_t;

#include "runtime/points/kernel/job.glsl"

inline const FlatGame* game = nullptr;
inline Job job;
inline bool FLAT, PERSPECTIVE, CLIMBS, LEAVES, WIDE, SOURCES, FORMULAS;
inline float slots[256];
inline uint CHANNELS;
inline std::vector<uint> words;

inline uvec4 choices(uint i) {
    return game->choices[i];
}
inline vec4 moves(uint i) {
    return game->moves[i];
}
inline uvec4 links(uint i) {
    return game->links[i];
}
inline uvec4 states(uint i) {
    return game->states[i];
}
inline vec4 colours(uint i) {
    return game->colours[i];
}
inline uvec4 steps(uint i) {
    return game->steps[i];
}
inline float numbers(uint i) {
    return game->numbers[i];
}
inline vec4 forms(uint i) {
    return game->forms[i];
}
inline float atan_of(float y, float x) {
    return std::atan2(y, x);
}
inline uint word_of(float x) {
    return floatBitsToUint(x);
}
inline float float_of(uint bits) {
    return uintBitsToFloat(bits);
}
inline void add_word(uint i, uint number) {
    words[i] += number;
}
inline void add_pair(uint pair, uint low, uint high) {
    words[2 * pair] += low;
    words[2 * pair + 1] += high;
}

inline constexpr bool PACKS = false;
inline void add_packed(uint, uvec2) {}

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
namespace {
#include "runtime/points/kernel/points.glsl"
} // namespace
#pragma GCC diagnostic pop

} // namespace graftal::points_kernel
