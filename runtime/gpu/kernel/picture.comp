// The words of the common subset, in GLSL.
#version 460
#extension GL_GOOGLE_include_directive : require

#define real float
#define FORMULA
#define REAL(x) float(x)
#define OUT(T) out T
#define INOUT(T) inout T
#define xyz_of(v) ((v).xyz)
#define bits_of(v) floatBitsToUint(v)
#define word_of(x) floatBitsToUint(x)
#define PI 3.14159265358979f
#define FAR 1e30f
#define PRECISE precise
#define min_uint(a, b) min(a, b)
#define LIMIT_LEVELS 6
#define LIMIT_RATIO 1.5f
#define float_of(word) uintBitsToFloat(word)
#define FRAMES \
    vec4 frame_places[MOST_FRAMES]; \
    uvec4 frame_marks[MOST_FRAMES]; \
    vec3 frame_directions[EVEN ? 2 : MOST_FRAMES]; \
    float frame_scales[STRETCHED || FAINTS ? MOST_FRAMES : 2]; \
    vec3 frame_margins[FAINTS ? MOST_FRAMES : 2]; \
    vec3 frame_lows[PAIRED ? MOST_FRAMES : 2];
#define MET_MARKS uint met_marks[MOST_FRAMES];
#define SPACES mat3 spaces[STRETCHED ? MOST_FRAMES : 2];
#define STEPS uint rays = 0u, steps = 0u, lost = 0u;
#define WAITING_PATHS Path waiting_paths[MOST_WAITING];

#include "runtime/gpu/kernel/layout.glsl"

layout(constant_id = 0) const int MOST_FRAMES = 64;
const int MOST_LATER = 5 * MOST_FRAMES;
layout(constant_id = 1) const bool AOVS = false; // in place of light
// Of the model. What it lacks takes neither registers nor memory of a ray.
layout(constant_id = 2) const bool STRETCHED = false; // some map of an object scales unevenly
layout(constant_id = 3) const bool EVEN = false;      // no map of an object turns or stretches anything
layout(constant_id = 4) const bool FAINTS = false;    // sets without area are drawn wider than they are
layout(constant_id = 5) const bool PATTERNS = false;  // some material has one
layout(constant_id = 6) const bool PICTURES = false;  // likewise
layout(constant_id = 7) const bool GLASS = false;     // some material lets light through
layout(constant_id = 8) const uint KINDS = 0x1ffu;    // of primitives: a bit each
layout(constant_id = 9) const bool PAIRED = false; // places of rays have two floats for each number
layout(constant_id = 10) const bool SHEETS = false; // some material is translucent
layout(constant_id = 11) const bool CRUSHES = false; // some map is singular
const bool MESHES = (KINDS & (1u << KIND_MESH)) != 0u;

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly restrict buffer Boxes { vec4 all_boxes[]; };
layout(std430, binding = 1) readonly restrict buffer Parts { vec4 all_parts[]; };
layout(std430, binding = 2) readonly restrict buffer Nodes { vec4 all_nodes[]; };
layout(std430, binding = 3) readonly restrict buffer Looks { vec4 all_looks[]; };
layout(std430, binding = 4) readonly restrict buffer Materials { vec4 all_materials[]; };
layout(std430, binding = 5) readonly restrict buffer Triangles { vec4 all_triangles[]; };
layout(std430, binding = 6) readonly restrict buffer Texels { float all_texels[]; };
layout(std140, binding = 7) uniform SceneBuffer { Scene scene; };
layout(std430, binding = 8) readonly restrict buffer Lows { vec4 all_lows[]; };
layout(std430, binding = 9) restrict buffer Film { vec4 film[]; };

#define boxes(i) all_boxes[i]
#define parts(i) all_parts[i]
#define lows(i) all_lows[i]
#define nodes(i) all_nodes[i]
#define looks(i) all_looks[i]
#define materials(i) all_materials[i]
#define triangles(i) all_triangles[i]
#define texels(i) all_texels[i]

float hypotenuse(float x, float y) {
    return length(vec2(x, y));
}

void cosine_and_sine(float angle, out float cosine, out float sine) {
    cosine = cos(angle);
    sine = sin(angle);
}

bool is_finite(vec3 v) {
    return !any(isnan(v)) && !any(isinf(v));
}

vec3 never_zero(vec3 d) {
    const float least = 1e-30f;
    return vec3(abs(d.x) < least ? least : d.x, abs(d.y) < least ? least : d.y, abs(d.z) < least ? least : d.z);
}

struct Job {
    uvec4 window; // x, y, width, height
    uvec4 picture; // width, height, first sample, samples
    uvec4 sequence; // low, high; the first pixel of the window in film[]; steps of a lattice
    uvec4 share;    // tiles from a row to the next
};
layout(push_constant) uniform Push { Job job; };

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

void main() {
    const uint i = gl_GlobalInvocationID.x;
    // Tiles of 8x8 pixels keep the threads of a group together.
    const uint across = (job.window.z + 7u) / 8u, tile = i / 64u;
    const uvec2 in_window =
        uvec2(8u * (tile % across) + i % 8u, 8u * (tile / across * job.share.x) + i / 8u % 8u);
    if (in_window.x >= job.window.z || in_window.y >= job.window.w) return;
    const uvec2 pixel = job.window.xy + in_window;
    const uint at = job.sequence.z + in_window.y * job.window.z + in_window.x;
    const vec2 size = vec2(job.picture.xy);
    if (AOVS)
        add_aovs(pixel, at, size, job.sequence.xy, job.picture.z, job.picture.w, job.sequence.w);
    else
        add_samples(pixel, at, size, job.sequence.xy, job.picture.z, job.picture.w, job.sequence.w);
}
