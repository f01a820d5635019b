// Random iteration, one wandering point a thread (ChaosPlayer of compiler/chaos, FlatGame).
#version 460
#ifdef ATOMICS_64
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
#endif

layout(constant_id = 0) const bool FLAT = false;    // x and y of no map depend on z
layout(constant_id = 1) const bool PERSPECTIVE = false;
layout(constant_id = 2) const uint CHANNELS = 0;    // of the colours that are summed: 0, 1 or 3
layout(constant_id = 3) const bool CLIMBS = false;  // from a core to the world
layout(constant_id = 4) const bool LEAVES = false;  // only by chance
layout(constant_id = 5) const bool WIDE = false;    // some table needs two random numbers

#define NONE 0xffffffffu
#define GROUP 128u
layout(local_size_x = 128) in;

// A slot of an alias table: the share of it that is its own, in 2^-32; its own move; the other one.
layout(std430, binding = 0) readonly restrict buffer Choices { uvec4 choices[]; };
// A move: three rows of its map, then its paint, which is what is fixed of a colour, and how much is open.
layout(std430, binding = 1) readonly restrict buffer Moves { vec4 moves[]; };
// Links of a move: the table of what comes next, its first slot and its number of slots. Then of one inside the core
// the state that it leads to; of one outside its material.
layout(std430, binding = 2) readonly restrict buffer Links { uvec4 links[]; };
// A state: the table of its climb, as above; the chance that a point leaves.
layout(std430, binding = 3) readonly restrict buffer States { uvec4 states[]; };
// Colours of materials; the last is behind what has met none.
layout(std430, binding = 4) readonly restrict buffer Colours { vec4 colours[]; };

struct Walker {
    vec4 place;
    vec4 paint;
    uvec4 random;
    uvec4 at; // table, state
};
layout(std430, binding = 5) restrict buffer Walkers { Walker walkers[]; };

// Cells, by pixel: the number of points alone; or pairs, the sum of a colour's levels and the number of points, and with
// three channels a second pair of sums. A pair may be added at once, since no sum flows over before its points do.
#if defined(ATOMICS_64)
layout(std430, binding = 6) buffer Cells { uint64_t pairs[]; };
layout(std430, binding = 6) buffer Words { uint words[]; };
#else
layout(std430, binding = 6) buffer Words { uint words[]; };
#endif

// By group: points inside the window; or the largest number in a cell, and the sum of all, its low halves and its high
// halves.
layout(std430, binding = 7) restrict buffer Totals { uvec4 totals[]; };

struct Job {
    uvec4 window; // width, height; first row and number of rows that are counted
    uvec4 work;   // walkers; moves of each; of them those with one more; what to do
    uvec4 start;  // first slot, slots; moves to settle; index of the last colour
    uvec4 more;   // seed; cells; levels of a colour
};
layout(push_constant) uniform Push { Job job; };

#define BEGIN 1u // and play
#define SWEEP 2u

// xoshiro128++ (Blackman and Vigna 2019).
uvec4 random;

uint turned(uint x, uint by) {
    return (x << by) | (x >> (32u - by));
}

uint next_random() {
    const uint drawn = turned(random.x + random.w, 7u) + random.x;
    const uint t = random.y << 9;
    random.z ^= random.x;
    random.w ^= random.y;
    random.y ^= random.z;
    random.x ^= random.w;
    random.z ^= t;
    random.w = turned(random.w, 11u);
    return drawn;
}

/// pcg4d (Jarzynski and Olano 2020).
uvec4 mixed(uvec4 v) {
    v = v * 1664525u + 1013904223u;
    v += v.yzxy * v.wxyz;
    v ^= v >> 16u;
    v += v.yzxy * v.wxyz;
    return v;
}

float unit_of(uint bits) {
    return float(bits >> 8) * (1.0 / 16777216.0);
}

/// A move of a table.
uint chosen(uvec2 table) {
    uint slot, rest;
    umulExtended(next_random(), table.y, slot, rest);
    if (WIDE) rest = next_random();
    const uvec4 choice = choices[table.x + slot];
    return rest < choice.x ? choice.y : choice.z;
}

struct Point {
    vec3 place;
    vec4 paint;
};

Point moved(Point point, uint move) {
    const vec4 x = moves[4u * move], y = moves[4u * move + 1u];
    Point image = point;
    if (FLAT) {
        image.place.x = x.x * point.place.x + x.y * point.place.y + x.w;
        image.place.y = y.x * point.place.x + y.y * point.place.y + y.w;
    } else {
        const vec4 z = moves[4u * move + 2u];
        image.place = vec3(dot(x.xyz, point.place) + x.w, dot(y.xyz, point.place) + y.w,
                           dot(z.xyz, point.place) + z.w);
    }
    if (CHANNELS > 0u) {
        const vec4 front = moves[4u * move + 3u];
        image.paint = vec4(front.xyz + front.w * point.paint.xyz, front.w * point.paint.w);
    }
    return image;
}

/// A colour's level, rounded up or down by chance so that its mean is right; `chance`: of [0, 1).
uint level_of(float value, float chance) {
    return uint(float(job.more.w) * clamp(value, 0.0, 1.0) + chance);
}

void add_pair(uint pair, uint low, uint high) {
#if defined(ATOMICS_64)
    atomicAdd(pairs[pair], packUint2x32(uvec2(low, high)));
#else
    atomicAdd(words[2u * pair], low);
    atomicAdd(words[2u * pair + 1u], high);
#endif
}

/// Counts a point; 1 if it is in the window.
uint count(Point point, uint material) {
    vec2 at = point.place.xy;
    if (PERSPECTIVE) {
        if (!(point.place.z > 0.0)) return 0u;
        at = at / point.place.z + 0.5 * vec2(job.window.xy);
    }
    if (!(at.x >= 0.0 && at.y >= 0.0 && at.x < float(job.window.x) && at.y < float(job.window.y))) return 0u;
    const uint row = uint(at.y) - job.window.z;
    if (row >= job.window.w) return 0u; // in another band
    const uint cell = row * job.window.x + uint(at.x);
    if (CHANNELS == 0u) {
        atomicAdd(words[cell], 1u);
        return 1u;
    }
    const vec3 rgb = point.paint.xyz + point.paint.w * colours[material].xyz;
    const uint chances = next_random();
    const float red_chance = float(chances & 0x3ffu) * (1.0 / 1024.0);
    if (CHANNELS == 1u) {
        add_pair(cell, level_of(rgb.x, red_chance), 1u);
        return 1u;
    }
    add_pair(2u * cell, level_of(rgb.x, red_chance), 1u);
    add_pair(2u * cell + 1u, level_of(rgb.y, float(chances >> 10 & 0x3ffu) * (1.0 / 1024.0)),
             level_of(rgb.z, float(chances >> 20 & 0x3ffu) * (1.0 / 1024.0)));
    return 1u;
}

shared uint of_group[3];

void play() {
    const uint i = gl_GlobalInvocationID.x;
    Point point;
    point.place = vec3(0.0);
    point.paint = vec4(0.0, 0.0, 0.0, 1.0);
    uvec4 link;
    uint inside = 0u;
    if (i < job.work.x) {
        if (job.work.w == BEGIN) {
            random = mixed(uvec4(i, job.more.xy, 0x9E3779B9u)) | uvec4(0u, 0u, 0u, 1u);
            uint move = chosen(job.start.xy);
            point = moved(point, move);
            link = links[move];
            for (uint k = 0u; k < job.start.z; ++k) {
                move = chosen(link.xy);
                point = moved(point, move);
                link = links[move];
            }
        } else {
            random = walkers[i].random;
            point.place = walkers[i].place.xyz;
            point.paint = walkers[i].paint;
            link = walkers[i].at;
        }
        const uint moves_of_it = job.work.y + (i < job.work.z ? 1u : 0u);
        for (uint k = 0u; k < moves_of_it;) {
            const uint move = chosen(link.xy);
            point = moved(point, move);
            link = links[move];
            if (!CLIMBS) {
                inside += count(point, job.start.w);
                ++k;
                continue;
            }
            uvec4 state = states[link.z];
            if (LEAVES && unit_of(next_random()) >= uintBitsToFloat(state.z)) continue;
            ++k;
            Point climbing = point;
            uint material = NONE;
            while (state.y > 0u) {
                const uint up = chosen(state.xy);
                climbing = moved(climbing, up);
                state = links[up];
                if (material == NONE) material = state.z;
            }
            inside += count(climbing, material == NONE ? job.start.w : material);
        }
        walkers[i].random = random;
        walkers[i].place = vec4(point.place, 0.0);
        walkers[i].paint = point.paint;
        walkers[i].at = link;
    }
    atomicAdd(of_group[0], inside);
    barrier();
    if (gl_LocalInvocationIndex == 0u) totals[gl_WorkGroupID.x] = uvec4(of_group[0], 0u, 0u, 0u);
}

#define CELLS_OF_THREAD 128u

/// Largest number and sum of a group's cells.
void sweep() {
    uint most = 0u, low = 0u, high = 0u;
    const uint first = gl_WorkGroupID.x * GROUP * CELLS_OF_THREAD + gl_LocalInvocationIndex;
    for (uint k = 0u; k < CELLS_OF_THREAD; ++k) {
        const uint cell = first + k * GROUP;
        if (cell >= job.more.z) break;
        const uint number = CHANNELS == 0u ? words[cell] : CHANNELS == 1u ? words[2u * cell + 1u] : words[4u * cell + 1u];
        most = max(most, number);
        low += number & 0xffffu;
        high += number >> 16;
    }
    atomicMax(of_group[0], most);
    atomicAdd(of_group[1], low);
    atomicAdd(of_group[2], high);
    barrier();
    if (gl_LocalInvocationIndex == 0u) totals[gl_WorkGroupID.x] = uvec4(of_group[0], of_group[1], of_group[2], 0u);
}

void main() {
    if (gl_LocalInvocationIndex < 3u) of_group[gl_LocalInvocationIndex] = 0u;
    barrier();
    if (job.work.w == SWEEP)
        sweep();
    else
        play();
}
