// Solid patterns of what a ray has met (Traversal::surface_at_best() and Shader::closest() of runtime/trace).

// Entries of a pattern in texels[]: of the whole, then of each layer.
#define PATTERN_SIZE 8u // layers, bump in lengths of a wave, the colours of 0 and 1
#define LAYER_SIZE 9u   // kind, octaves, warp, scale, 1 if that is of the world, stretch, share

void pattern_wave(int level, int number, OUT(vec3) direction, OUT(float) phase) {
    const uint at = scene.tables.z + 4u * (PATTERN_WAVES * uint(level & (PATTERN_LEVELS - 1)) + uint(number));
    direction = vec3(texels(at), texels(at + 1u), texels(at + 2u));
    phase = texels(at + 3u);
}

#include "runtime/trace/shade/patterns.glsl"

vec3 three_texels(uint at) {
    return vec3(texels(at), texels(at + 1u), texels(at + 2u));
}

/// Gives what was met the colour and the relief that its material's pattern has there.
void show_pattern(vec3 o, vec3 d, INOUT(Hit) hit) {
    const uint pattern = bits_of(materials(hit.material * MATERIAL_SIZE + 3u)).w;
    if (pattern == NONE || !(hit.pattern_size > 0.0f)) return;
    const vec3 from_eye = o + hit.t * d;
    float footprint;
    if (hit.is_level) {
        footprint = least_distance(from_eye, 1.0f) / sqrt(max(abs(d.y), 1e-3f));
    } else if (scene.direction.w > 0.0f) {
        footprint = scene.lens.z;
    } else {
        const float depth = max(dot(from_eye, xyz_of(scene.direction)), 0.5f * length(from_eye));
        footprint = scene.lens.z * max(depth, scene.projection.y);
    }
    const vec3 place = from_eye + xyz_of(scene.eye);
    float value = 0.5f;
    vec3 relief = vec3(0.0f);
    float faded = 0.0f;
    uint at = pattern + PATTERN_SIZE;
    for (uint i = 0u; i < uint(texels(pattern)); ++i) {
        const float wavelength = texels(at + 3u) * (texels(at + 4u) > 0.0f ? 1.0f : hit.pattern_size);
        const vec3 stretch = three_texels(at + 5u);
        const float share = texels(at + 8u);
        vec3 slope;
        float lost;
        const float layer = pattern_layer(int(texels(at)), int(texels(at + 1u)), texels(at + 2u), wavelength,
                                          footprint, stretch, place, slope, lost);
        value = mix(value, layer, share);
        relief = mix(relief, wavelength * slope, share);
        faded = squared(1.0f - share) * faded + squared(share * wavelength) * lost;
        at += LAYER_SIZE;
    }
    const float bump = texels(pattern + 1u);
    if (dot(hit.normal, d) > 0.0f) hit.normal = -hit.normal;
    if (bump != 0.0f) hit.normal = pattern_normal(hit.normal, bump * relief, d);
    hit.faded = bump * bump * faded;
    const vec3 own = xyz_of(materials(hit.material * MATERIAL_SIZE));
    const vec3 shown = value < 0.5f ? mix(three_texels(pattern + 2u), own, 2.0f * value)
                                    : mix(own, three_texels(pattern + 5u), 2.0f * value - 1.0f);
    hit.rgb = xyz_of(hit.tint) + hit.tint.w * shown;
}
