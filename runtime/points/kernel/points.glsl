// Random iteration, one wandering point a thread (ChaosPlayer of compiler/chaos): the text that tests step through as C++.
//
// choices(), a slot of an alias table: the share of it that is its own, in 2^-32; its own move; the other one.
// moves(), four numbers a move: three rows of its map, then its paint: what is fixed of a colour, and how much is open.
// links() of a move: the table of what comes next, its first slot and its number of slots. Then of a move in the core
// the state that it leads to; of one outside its material.
// states(): the table of a state's climb, likewise; the chance that a point leaves.
// Of formulas, links() are the table and in the fourth number the material of a map, states() its first step and its
// steps, and moves() its paint alone.
// colours() of materials; the last is behind what has met none.

#define NO_MATERIAL 0xffffffffu
#define CORE 0xffffffffu // as a source

struct Walker {
    vec4 place;
    vec4 paint;
    uvec4 random;
    uvec4 at; // links of the move before
};

/// pcg4d (Jarzynski and Olano 2020).
uvec4 mixed(uvec4 v) {
    v = v * 1664525u + 1013904223u;
    for (int i = 0; i < 2; ++i) {
        v.x += v.y * v.w;
        v.y += v.z * v.x;
        v.z += v.x * v.y;
        v.w += v.y * v.z;
        if (i == 0) v = v ^ (v >> 16u);
    }
    return v;
}

uint turned(uint x, uint by) {
    return (x << by) | (x >> (32u - by));
}

/// xoshiro128++ (Blackman and Vigna 2019).
uint next_random(INOUT(uvec4) random) {
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

/// Of [0, 1).
float unit_of(uint bits) {
    return float(bits >> 8) * (1.0f / 16777216.0f);
}

/// A move of a table.
uint chosen(uvec4 table, INOUT(uvec4) random) {
    uint slot, rest;
    umulExtended(next_random(random), table.y, slot, rest);
    if (WIDE) rest = next_random(random);
    const uvec4 choice = choices(table.x + slot);
    return rest < choice.x ? choice.y : choice.z;
}

struct Point {
    vec3 place;
    vec4 paint;
};

#include "runtime/points/kernel/formulas.glsl"

vec3 mapped(vec3 p, uint move) {
    const vec4 x = moves(4u * move), y = moves(4u * move + 1u);
    if (FLAT) return vec3(x.x * p.x + x.y * p.y + x.w, y.x * p.x + y.y * p.y + y.w, p.z);
    const vec4 z = moves(4u * move + 2u);
    return vec3(x.x * p.x + x.y * p.y + x.z * p.z + x.w, y.x * p.x + y.y * p.y + y.z * p.z + y.w,
                z.x * p.x + z.y * p.y + z.z * p.z + z.w);
}

/// A paint behind that of a move.
vec4 painted(vec4 paint, uint move) {
    if (CHANNELS == 0u) return paint;
    const vec4 front = moves(4u * move + 3u);
    return vec4(front.x + front.w * paint.x, front.y + front.w * paint.y, front.z + front.w * paint.z,
                front.w * paint.w);
}

/// A colour's level, rounded up or down by chance, so that its mean is right. `chances`: random bits, of which ten
/// are used.
uint level_of(float value, uint chances) {
    return uint(float(job.more.w) * clamp(value, 0.0f, 1.0f) + float(chances & 1023u) * (1.0f / 1024.0f));
}

/// A point in 64 bits: its number in ten, then 18 each for red, green and blue. The sums of 1023 points have room.
uvec2 packed(uint red, uint green, uint blue) {
    return uvec2(blue | (green << 18), (red << 4) | (1u << 22));
}

/// The sums of red, points, green and blue.
uvec4 unpacked(uvec2 sums) {
    return uvec4((sums.y >> 4) & 0x3ffffu, sums.y >> 22, ((sums.y & 15u) << 14) | (sums.x >> 18), sums.x & 0x3ffffu);
}

/// Counts a point; 1 if it is in the window.
uint counted(Point point, uint material, INOUT(uvec4) random) {
    const vec2 size = vec2(float(job.window.x), float(job.window.y));
    vec2 at = vec2(point.place.x, point.place.y);
    if (PERSPECTIVE) {
        if (!(point.place.z > 0.0f)) return 0u;
        at = at / point.place.z + 0.5f * size;
    }
    if (!(at.x >= 0.0f && at.y >= 0.0f && at.x < size.x && at.y < size.y)) return 0u;
    const uint chances = CHANNELS > 0u ? next_random(random) : 0u; // in all bands alike
    const uint row = uint(at.y) - job.window.z;
    if (row >= job.window.w) return 0u;
    const uint cell = row * job.window.x + uint(at.x);
    if (CHANNELS == 0u) {
        add_word(cell, 1u);
        return 1u;
    }
    const vec4 behind = colours(material == NO_MATERIAL ? job.start.w : material);
    const uint red = level_of(point.paint.x + point.paint.w * behind.x, chances);
    if (CHANNELS == 1u) {
        add_pair(cell, red, 1u);
        return 1u;
    }
    const uint green = level_of(point.paint.y + point.paint.w * behind.y, chances >> 10),
               blue = level_of(point.paint.z + point.paint.w * behind.z, chances >> 20);
    if (PACKS) {
        add_packed(cell, packed(red, green, blue));
        return 1u;
    }
    add_pair(2u * cell, red, 1u);
    add_pair(2u * cell + 1u, green, blue);
    return 1u;
}

#include "runtime/points/kernel/surfaces.glsl"

#define MOST_ASTRAY 5u // in sequence, before a point counts

/// A place where an orbit begins again; false if it does not.
bool begin_again(INOUT(vec3) place, INOUT(uvec4) random) {
    const float far = float_of(job.orbit.w);
    if (!(far > 0.0f)) return false;
    const float x = unit_of(next_random(random)), y = unit_of(next_random(random));
    place = vec3(far * (2.0f * x - 1.0f), far * (2.0f * y - 1.0f), 0.0f);
    return true;
}

/// Moves a point on; false where that is impossible.
bool wander(INOUT(Point) point, INOUT(uvec4) at, INOUT(uvec4) random) {
    const uvec4 table = at;
    for (uint attempt = 1u; attempt <= MOST_ASTRAY; ++attempt) {
        const uint move = chosen(table, random);
        const uint material = at.w;
        at = links(move);
        point.paint = painted(point.paint, move);
        if (!FORMULAS) {
            point.place = mapped(point.place, move);
            return true;
        }
        if (at.w == NO_MATERIAL) at.w = material;
        if (compute(move, point.place, random)) return true;
        if (!begin_again(point.place, random)) return false;
    }
    return true;
}

/// Counts what is shown of an orbit's point. Behind the maps is the last move: the formulas of `final`, if there are
/// any, and the way to what is seen.
bool count_orbit(Point point, uint material, INOUT(uint) inside, INOUT(uvec4) random) {
    const uint last = job.orbit.x;
    if (states(last).y > 0u && !compute(last, point.place, random) && !begin_again(point.place, random)) return false;
    const uint of_last = links(last).w;
    point.place = mapped(point.place, last);
    point.paint = painted(point.paint, last);
    inside += counted(point, of_last == NO_MATERIAL ? material : of_last, random);
    return true;
}

Walker new_walker(uint number) {
    Walker walker;
    walker.random = mixed(uvec4(number, job.more.x, job.more.y, 0x9E3779B9u));
    walker.random.w |= 1u;
    walker.at = uvec4(job.start.x, job.start.y, 0u, NO_MATERIAL);
    walker.place = job.origin;
    walker.paint = vec4(0.0f, 0.0f, 0.0f, 1.0f);
    return walker;
}

/// The points of a walker; how many of them were in the window. The fourth number of its place is 1 where it went astray.
uint played(uint number, INOUT(Walker) walker) {
    uvec4 random = walker.random, at = walker.at;
    Point point;
    point.place = vec3(walker.place.x, walker.place.y, walker.place.z);
    point.paint = walker.paint;
    bool goes_on = true;
    if ((job.work.w & JOB_BEGINS) != 0u)
        for (uint i = 0u; i < job.start.z && goes_on; ++i)
            goes_on = wander(point, at, random);
    uint inside = 0u;
    const uint points = job.work.y + (number < job.work.z ? 1u : 0u);
    for (uint i = 0u; i < points && goes_on; ++i) {
        if (FORMULAS) {
            goes_on = wander(point, at, random) && count_orbit(point, at.w, inside, random);
            continue;
        }
        uint source = SOURCES ? chosen(uvec4(job.sources.x, job.sources.y, 0u, 0u), random) : CORE;
        Point climbing;
        uvec4 up;
        uint material;
        if (source == CORE) {
            do
                wander(point, at, random);
            while (LEAVES && unit_of(next_random(random)) >= float_of(states(at.z).z));
            climbing = point;
            if (CLIMBS) up = states(at.z);
            material = job.orbit.y;
        } else {
            climbing.place = surface_place(source, random);
            climbing.place = mapped(climbing.place, source);
            climbing.paint = painted(vec4(0.0f, 0.0f, 0.0f, 1.0f), source);
            up = links(source);
            material = up.z;
        }
        if (CLIMBS)
            while (up.y > 0u) {
                wander(climbing, up, random);
                if (material == NO_MATERIAL) material = up.z;
            }
        inside += counted(climbing, material, random);
    }
    walker.random = random;
    walker.at = at;
    walker.place = vec4(point.place.x, point.place.y, point.place.z, goes_on ? 0.0f : 1.0f);
    walker.paint = point.paint;
    return inside;
}
