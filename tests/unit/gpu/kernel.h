#pragma once

// The kernel of GPUs as C++: GLM has the words of GLSL, and the arrays are those of a FlatModel. So tests
// step through it without a device, and compare numbers.

#include <cmath>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "runtime/gpu/flat_model.h"

#define FORMULA inline
#define PRECISE
#define REAL(number) float(number)
#define OUT(Type) Type&
#define INOUT(Type) Type&
#define LIMIT_LEVELS 6
#define LIMIT_RATIO 1.5f
#define FRAMES                                                                                               \
    inline thread_local vec4 frame_places[MOST_FRAMES];                                                      \
    inline thread_local uvec4 frame_marks[MOST_FRAMES];                                                      \
    inline thread_local vec3 frame_directions[MOST_FRAMES];                                                  \
    inline thread_local float frame_scales[MOST_FRAMES];                                                     \
    inline thread_local vec3 frame_margins[MOST_FRAMES];                                                     \
    inline thread_local vec3 frame_lows[MOST_FRAMES];
#define MET_MARKS inline thread_local uint met_marks[MOST_FRAMES];
#define SPACES inline thread_local mat3 spaces[MOST_FRAMES];
#define STEPS inline thread_local uint rays = 0, steps = 0, lost = 0;
#define WAITING_PATHS inline thread_local Path waiting_paths[MOST_WAITING];

namespace graftal::kernel {

using namespace glm;
using uint = std::uint32_t;
using real = float;
using kernel_layout::Lamp;
using kernel_layout::Scene;

inline constexpr float PI = 3.14159265358979f;
inline constexpr float FAR = 1e30f;
inline constexpr int MOST_FRAMES = 64, MOST_LATER = 5 * MOST_FRAMES;
inline thread_local bool STRETCHED = false, EVEN = false, FAINTS = false, PATTERNS = false, PICTURES = false,
                         GLASS = false, MESHES = false, PAIRED = false, SHEETS = false, CRUSHES = false;
inline thread_local std::uint32_t KINDS = 0;

inline thread_local const FlatModel* model = nullptr;
inline thread_local Scene scene;
inline thread_local std::vector<vec4> film;

inline void use(const FlatModel& flat) {
    model = &flat;
    scene = flat.scene;
    const FlatModel::Features& has = flat.features;
    STRETCHED = has.stretched;
    EVEN = has.even;
    FAINTS = flat.scene.widths.z > 0;
    PATTERNS = has.patterned;
    PICTURES = has.pictured;
    GLASS = has.glassy;
    PAIRED = has.paired;
    SHEETS = has.translucent;
    CRUSHES = has.crushed;
    KINDS = has.kinds;
    MESHES = (KINDS & (1u << KIND_MESH)) != 0;
}

inline uint min_uint(uint a, uint b) {
    return a < b ? a : b;
}
inline vec3 xyz_of(vec4 v) {
    return vec3(v);
}
inline uvec4 bits_of(vec4 v) {
    return floatBitsToUint(v);
}
inline uint word_of(float x) {
    return floatBitsToUint(x);
}
inline float float_of(uint word) {
    return uintBitsToFloat(word);
}
inline vec4 boxes(uint i) {
    return model->boxes[i];
}
inline vec4 parts(uint i) {
    return model->parts[i];
}
inline vec4 lows(uint i) {
    return model->lows[i];
}
inline vec4 nodes(uint i) {
    return model->nodes[i];
}
inline vec4 looks(uint i) {
    return model->looks[i];
}
inline vec4 materials(uint i) {
    return model->materials[i];
}
inline vec4 triangles(uint i) {
    return model->triangles[i];
}
inline float texels(uint i) {
    return model->texels[i];
}
inline float hypotenuse(float x, float y) {
    return std::hypot(x, y);
}
inline void cosine_and_sine(float angle, float& cosine, float& sine) {
    cosine = std::cos(angle);
    sine = std::sin(angle);
}
inline bool is_finite(vec3 v) {
    return !any(isnan(v)) && !any(isinf(v));
}
inline vec3 never_zero(vec3 d) {
    const float least = 1e-30f;
    return vec3(abs(d.x) < least ? least : d.x, abs(d.y) < least ? least : d.y,
                abs(d.z) < least ? least : d.z);
}

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
namespace { // the texts say nothing of linkage; each uses those before it
// clang-format off
#include "runtime/trace/shade/formulas.glsl"
#include "compiler/light/formulas.glsl"
#include "compiler/primitives/sheet.glsl"
#include "runtime/gpu/kernel/primitives.glsl"
#include "runtime/gpu/kernel/frames.glsl"
#include "runtime/gpu/kernel/meeting.glsl"
#include "runtime/gpu/kernel/walk.glsl"
#include "runtime/gpu/kernel/random.glsl"
#include "runtime/gpu/kernel/sky.glsl"
#include "runtime/gpu/kernel/material.glsl"
#include "runtime/gpu/kernel/light.glsl"
#include "runtime/gpu/kernel/picture.glsl"
// clang-format on
} // namespace
#pragma GCC diagnostic pop

} // namespace graftal::kernel
