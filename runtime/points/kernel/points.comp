// The words of the common subset of points.glsl, in GLSL.
#version 460
#extension GL_GOOGLE_include_directive : require
#ifdef ATOMICS_64
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
#endif

#define INOUT(T) inout T
#define choices(i) all_choices[i]
#define moves(i) all_moves[i]
#define links(i) all_links[i]
#define states(i) all_states[i]
#define colours(i) all_colours[i]
#define float_of(bits) uintBitsToFloat(bits)
#define forms(i) all_forms[i]
#define word_of(x) floatBitsToUint(x)
#define steps(i) all_steps[i]
#define numbers(i) all_numbers[i]
#define atan_of(y, x) atan(y, x)
#define add_word(i, number) atomicAdd(words[i], number)

layout(constant_id = 0) const bool FLAT = false; // x and y of no map depend on z
layout(constant_id = 1) const bool PERSPECTIVE = false;
layout(constant_id = 2) const uint CHANNELS = 0;   // of the colours that are summed: 0, 1 or 3
layout(constant_id = 3) const bool CLIMBS = false; // from a core to the world
layout(constant_id = 4) const bool LEAVES = false; // only by chance
layout(constant_id = 5) const bool WIDE = false;   // some table needs two random numbers

layout(constant_id = 6) const bool SOURCES = false; // others than the core
layout(constant_id = 7) const bool FORMULAS = false;
layout(constant_id = 8) const int SLOTS = 6; // of formulas

layout(local_size_x = 128) in;
layout(std430, binding = 0) readonly restrict buffer Choices { uvec4 all_choices[]; };
layout(std430, binding = 1) readonly restrict buffer Moves { vec4 all_moves[]; };
layout(std430, binding = 2) readonly restrict buffer Links { uvec4 all_links[]; };
layout(std430, binding = 3) readonly restrict buffer States { uvec4 all_states[]; };
layout(std430, binding = 4) readonly restrict buffer Colours { vec4 all_colours[]; };
layout(std430, binding = 9) readonly restrict buffer Steps { uvec4 all_steps[]; };
layout(std430, binding = 10) readonly restrict buffer Numbers { float all_numbers[]; };
layout(std430, binding = 11) readonly restrict buffer Forms { vec4 all_forms[]; };

float slots[SLOTS];

// Cells, by pixel: the number of points alone; or a pair, the sum of a colour's levels and the number of points, and
// with three channels a second pair of sums.
layout(std430, binding = 6) buffer Words { uint words[]; };

#include "runtime/points/kernel/job.glsl"
layout(push_constant) uniform Push { Job job; };

// A pair may be added at once: no sum flows over before its points do.
#ifdef ATOMICS_64
layout(std430, binding = 6) buffer Pairs { uint64_t pairs[]; };
layout(std430, binding = 8) restrict buffer Packed { uint64_t packed_cells[]; };
#define PACKS ((job.work.w & JOB_PACKS) != 0u)

void add_pair(uint pair, uint low, uint high) {
    atomicAdd(pairs[pair], packUint2x32(uvec2(low, high)));
}
#else
#define PACKS false

void add_pair(uint pair, uint low, uint high) {
    atomicAdd(words[2u * pair], low);
    atomicAdd(words[2u * pair + 1u], high);
}
#endif

void add_packed(uint cell, uvec2 point);

#include "runtime/points/kernel/points.glsl"

#ifdef ATOMICS_64
/// Takes the packed sums of a cell to its pairs; their number of points.
uint unpack_cell(uint cell) {
    const uvec4 sums = unpacked(unpackUint2x32(atomicExchange(packed_cells[cell], uint64_t(0))));
    add_pair(2u * cell, sums.x, sums.y);
    add_pair(2u * cell + 1u, sums.z, sums.w);
    return sums.y;
}

/// Of 256 points the last one unpacks its cell. It holds 1023, so that other points have time to come meanwhile.
void add_packed(uint cell, uvec2 point) {
    const uint before = unpackUint2x32(atomicAdd(packed_cells[cell], packUint2x32(point))).y >> 22;
    if ((before & 255u) == 255u) unpack_cell(cell);
}
#else
void add_packed(uint cell, uvec2 point) {}
#endif

layout(std430, binding = 5) restrict buffer Walkers { Walker walkers[]; };

// By group: points inside the window, and walkers that went astray; or the largest number in a cell, and the sum of all, its low halves and its high
// halves.
layout(std430, binding = 7) restrict buffer Totals { uvec4 totals[]; };

shared uint of_group[3];

/// Largest number and sum of a group's cells.
void sweep() {
    uint most = 0u, low = 0u, high = 0u;
    const uint first = gl_WorkGroupID.x * GROUP_SIZE * CELLS_OF_THREAD + gl_LocalInvocationIndex;
    for (uint k = 0u; k < CELLS_OF_THREAD; ++k) {
        const uint cell = first + k * GROUP_SIZE;
        if (cell >= job.more.z) break;
        uint number = words[CHANNELS == 0u ? cell : CHANNELS == 1u ? 2u * cell + 1u : 4u * cell + 1u];
#ifdef ATOMICS_64
        if (PACKS && packed_cells[cell] != uint64_t(0)) number += unpack_cell(cell);
#endif
        most = max(most, number);
        low += number & 0xffffu;
        high += number >> 16;
    }
    atomicMax(of_group[0], most);
    atomicAdd(of_group[1], low);
    atomicAdd(of_group[2], high);
}

void main() {
    if (gl_LocalInvocationIndex < 3u) of_group[gl_LocalInvocationIndex] = 0u;
    barrier();
    const uint i = gl_GlobalInvocationID.x;
    if ((job.work.w & JOB_SWEEPS) != 0u)
        sweep();
    else if (i < job.work.x) {
        Walker walker;
        if ((job.work.w & JOB_BEGINS) != 0u)
            walker = new_walker(i);
        else
            walker = walkers[i];
        atomicAdd(of_group[0], played(i, walker));
        if (walker.place.w > 0.0) atomicAdd(of_group[1], 1u);
        walkers[i] = walker;
    }
    barrier();
    if (gl_LocalInvocationIndex == 0u)
        totals[gl_WorkGroupID.x] = uvec4(of_group[0], of_group[1], of_group[2], 0u);
}
