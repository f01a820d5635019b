// The formulas of orbits, by steps, whose operations have the numbers of ExpressionStep (compiler/syntax/steps).
// steps(): the operation, 256 if an expression ends there, and in the high half the slot of its result; two halves each
// for four operands; pieces of a table.

#define IS_NUMBER 0x8000u
#define DEGREES 57.29577951308232f
#define NO_VALUE float_of(0x7fc00000u)

bool has_no_value(float x) {
    return (word_of(x) & 0x7f800000u) == 0x7f800000u;
}

float operand(uint place) {
    return (place & IS_NUMBER) != 0u ? numbers(place & (IS_NUMBER - 1u)) : slots[place];
}

float as_number(bool holds) {
    return holds ? 1.0f : 0.0f;
}

/// Of degrees, exact at multiples of 30 and 90 where the value is 0, 1/2 or 1.
float sine(float degrees) {
    const float turn = degrees - 360.0f * floor(degrees / 360.0f + 0.5f);
    const float acute = abs(turn) > 90.0f ? 180.0f - abs(turn) : abs(turn);
    const float value = acute == 30.0f ? 0.5f : acute == 90.0f ? 1.0f : sin(acute / DEGREES);
    return turn < 0.0f ? -value : value;
}

float cosine(float degrees) {
    return sine(90.0f - abs(degrees - 360.0f * floor(degrees / 360.0f + 0.5f)));
}

float arc_tangent(float y, float x) {
    if (x == 0.0f && y == 0.0f) return 0.0f;
    return atan_of(y, x) * DEGREES;
}

/// With the sign of x, as C has it.
float remainder_of(float x, float y) {
    return y == 0.0f ? NO_VALUE : x - y * trunc(x / y);
}

float power(float x, float y) {
    if (y == 0.0f) return 1.0f;
    if (x == 0.0f) return y > 0.0f ? 0.0f : NO_VALUE;
    if (x > 0.0f) return pow(x, y);
    if (y != floor(y)) return NO_VALUE;
    const float size = pow(-x, y);
    return 0.5f * y == floor(0.5f * y) ? size : -size;
}

float smooth_step(float low, float high, float x) {
    if (low == high) return x < low ? 0.0f : 1.0f;
    const float t = clamp((x - low) / (high - low), 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

/// The inverse of the error function (Giles 2010, "Approximating the erfinv function").
float inverse_erf(float x) {
    float w = -log((1.0f - x) * (1.0f + x));
    float p;
    if (w < 5.0f) {
        w = w - 2.5f;
        p = 2.81022636e-08f;
        p = 3.43273939e-07f + p * w;
        p = -3.5233877e-06f + p * w;
        p = -4.39150654e-06f + p * w;
        p = 0.00021858087f + p * w;
        p = -0.00125372503f + p * w;
        p = -0.00417768164f + p * w;
        p = 0.246640727f + p * w;
        p = 1.50140941f + p * w;
    } else {
        w = sqrt(w) - 3.0f;
        p = -0.000200214257f;
        p = 0.000100950558f + p * w;
        p = 0.00134934322f + p * w;
        p = -0.00367342844f + p * w;
        p = 0.00573950773f + p * w;
        p = -0.0076224613f + p * w;
        p = 0.00943887047f + p * w;
        p = 1.00167406f + p * w;
        p = 2.83297682f + p * w;
    }
    return p * x;
}

/// Cut off at three deviations, outside of which 0.27 % would lie.
float normal(float uniform_number, float mean, float deviation) {
    const float within = 0.9973002f;
    if (deviation < 0.0f) return NO_VALUE;
    return mean + deviation * clamp(1.41421356f * inverse_erf(within * (2.0f * uniform_number - 1.0f)), -3.0f, 3.0f);
}

float table_value(uint first, uint pieces, float x) {
    const float place = clamp(x, 0.0f, 1.0f) * float(pieces);
    const float piece = min(floor(place), float(pieces) - 1.0f);
    const uint at = first + uint(piece);
    return numbers(at) + (place - piece) * (numbers(at + 1u) - numbers(at));
}

/// The value of a step. It has none where an operand that it needs has none.
float value_of(uvec4 step) {
    const uint operation = step.x & 255u;
    const float a = operand(step.y & 0xffffu);
    if (has_no_value(a)) return a;
    const float b = operation == 18u ? a : operand(step.y >> 16);
    if (operation == 12u) return a == 0.0f ? 0.0f : has_no_value(b) ? b : as_number(b != 0.0f);
    if (operation == 13u) return a != 0.0f ? 1.0f : has_no_value(b) ? b : as_number(b != 0.0f);
    if (operation == 39u) return a != 0.0f ? b : operand(step.z & 0xffffu);
    if (has_no_value(b)) return b;
    const float c = operand(step.z & 0xffffu);
    if (has_no_value(c)) return c;
    switch (operation) {
    case 0u: return a + b;
    case 1u: return a - b;
    case 2u: return a * b;
    case 3u: return b == 0.0f ? NO_VALUE : a / b;
    case 4u: return remainder_of(a, b);
    case 5u: return power(a, b);
    case 6u: return as_number(a == b);
    case 7u: return as_number(a != b);
    case 8u: return as_number(a < b);
    case 9u: return as_number(a <= b);
    case 10u: return as_number(a > b);
    case 11u: return as_number(a >= b);
    case 14u: return a;
    case 15u: return -a;
    case 16u: return as_number(a == 0.0f);
    case 18u: return table_value(step.y >> 16 & (IS_NUMBER - 1u), step.w, a);
    case 20u: return sine(a);
    case 21u: return cosine(a);
    case 22u: return cosine(a) == 0.0f ? NO_VALUE : sine(a) / cosine(a);
    case 23u: return abs(a) > 1.0f ? NO_VALUE : asin(a) * DEGREES;
    case 24u: return abs(a) > 1.0f ? NO_VALUE : acos(a) * DEGREES;
    case 25u: return atan(a) * DEGREES;
    case 26u: return arc_tangent(a, b);
    case 27u: return a < 0.0f ? NO_VALUE : sqrt(a);
    case 28u: return exp(a);
    case 29u: return a <= 0.0f ? NO_VALUE : log(a);
    case 30u: return floor(a);
    case 31u: return ceil(a);
    case 32u: return abs(a);
    case 33u: return sign(a);
    case 34u: return min(a, b);
    case 35u: return max(a, b);
    case 36u: return remainder_of(a, b);
    case 37u: return power(a, b);
    case 38u: return a + c * (b - a);
    case 40u: return smooth_step(a, b, c);
    case 41u: return b / (1.0f + exp(-c * (a - operand(step.z >> 16))));
    case 60u: return normal(a, b, c);
    case 61u: return b + a * (c - b);
    }
    return NO_VALUE;
}

#define FARTHEST 1e10f

/// Maps a place by the formulas of a map; false where it goes astray.
bool compute(uint map, INOUT(vec3) place, INOUT(uvec4) random) {
    slots[3] = place.x;
    slots[4] = place.y;
    slots[5] = place.z;
    const uvec4 program = states(map);
    for (uint i = program.x; i < program.x + program.y; ++i) {
        const uvec4 step = steps(i);
        const float value = (step.x & 255u) == 17u ? unit_of(next_random(random)) : value_of(step);
        if ((step.x & 256u) != 0u && has_no_value(value)) return false;
        slots[step.x >> 16] = value;
    }
    place = vec3(slots[0], slots[1], slots[2]);
    return max(max(abs(place.x), abs(place.y)), abs(place.z)) <= FARTHEST;
}
