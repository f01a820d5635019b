// Pixels: camera rays, samples and their mean (PictureTracer of runtime/trace).

#define SUMS_A_PIXEL 2u
#define AOVS_A_PIXEL 4u

/// The ray through a point of the picture, in pixels.
void camera_ray(vec2 at, vec2 size, INOUT(Stream) stream, OUT(vec3) o, OUT(vec3) d) {
    const vec3 across = scene.right.w * (2.0f * at.x / size.x - 1.0f) * xyz_of(scene.right) +
                        scene.up.w * (1.0f - 2.0f * at.y / size.y) * xyz_of(scene.up);
    o = vec3(0.0f);
    d = xyz_of(scene.direction);
    if (scene.direction.w > 0.0f) {
        o = across;
        return;
    }
    d = normalize(d + across);
    if (scene.lens.x > 0.0f) {
        const vec2 place = next_place(stream);
        const float radius = scene.lens.x * sqrt(place.x), turn = 2.0f * PI * place.y;
        o = radius * (cos(turn) * xyz_of(scene.right) + sin(turn) * xyz_of(scene.up));
        d = normalize(scene.lens.y / dot(d, xyz_of(scene.direction)) * d - o);
    }
}

float srgb_encoded(float light) {
    const float x = clamp(light, 0.0f, 1.0f);
    return x <= 0.0031308f ? 12.92f * x : 1.055f * pow(x, 1.0f / 2.4f) - 0.055f;
}

/// A grey light as the film shows it (image/develop.h), in 255ths.
float shown_255(float light) {
    const float x = scene.ambient.w * light;
    return 255.0f * srgb_encoded(scene.looks.x != 0u && x > 0.5f ? 1.0f - 0.5f * exp(1.0f - 2.0f * x) : x);
}

/// The standard error of a pixel's mean (NoiseMeter::error_255()).
float error_255(float count, float mean, float squares) {
    const float error = sqrt(squares / (count - 1.0f) / count);
    return 0.5f * (shown_255(mean + error) - shown_255(max(mean - error, 0.0f)));
}

/// Offset of a sample from its pixel's middle: a table of the filter follows the sky's picture in texels[].
float filter_offset(float place) {
    const float at = place * float(FILTER_STEPS);
    const uint step = min_uint(uint(at), uint(FILTER_STEPS) - 1u);
    const float share = at - float(step);
    return mix(texels(scene.tables.x + step), texels(scene.tables.x + step + 1u), share);
}

/// A sample's place in its pixel, and its weight there.
struct Place {
    vec2 in_pixel;
    float weight;
};

/// With `lattice` the samples are those of a lattice of as many squares along each side of the pixel, as POV-Ray
/// takes it, or with 1 the pixel's middle alone.
Place place_of_sample(uint i, uint lattice, INOUT(Stream) stream) {
    Place place;
    place.weight = 1.0f;
    place.in_pixel = vec2(0.5f);
    if (lattice == 0u) {
        const vec2 chosen = next_place(stream);
        place.in_pixel += vec2(filter_offset(chosen.x), filter_offset(chosen.y));
    } else if (lattice > 1u) {
        const uint x = i % (lattice + 1u), y = i / (lattice + 1u);
        place.in_pixel = vec2(float(x), float(y)) / float(lattice);
        place.weight = (x > 0u && x < lattice ? 1.0f : 0.5f) * (y > 0u && y < lattice ? 1.0f : 0.5f);
    }
    return place;
}

Stream stream_of_pixel(uvec2 pixel, uvec2 sequence, uint i) {
    return stream_of(uvec2(pixel.x, pixel.y ^ (sequence.x << 16)), i);
}

/// Whether the device ends loops before their time, as drivers by software do after some ten thousand rounds in all:
/// then it ends this one, too. Its rounds are no constant, or drivers would need no loop; and Mesa takes for granted
/// that the condition of a loop is false behind it, so that this asks for another.
bool ends_loops_early() {
    uint rounds = 0u;
    while (rounds < scene.looks.y)
        ++rounds;
    return rounds != scene.looks.y;
}

/// Adds samples `first` to `first + count` to a pixel. `film`: the weighted sum of its light and the weights;
/// then the mean and the sum of squares of the luminance, and the steps and the number of rays in
/// thousands. Steps from STEPS_LOST on: some part had no room; from STEPS_ENDED on: the device ended loops. The film is
/// read again for each sample: what a ray keeps takes registers.
void add_samples(uvec2 pixel, uint at, vec2 size, uvec2 sequence, uint first, uint count, uint lattice) {
    rays = 0u;
    steps = 0u;
    lost = 0u;
    for (uint i = first; i < first + count; ++i) {
        const vec4 before = film[SUMS_A_PIXEL * at + 1u];
        const float weights = film[SUMS_A_PIXEL * at].w;
        if (lattice == 0u && weights > 0.0f && uint(weights) % 16u == 0u &&
            error_255(weights, before.x, before.y) < scene.limits.z)
            break;
        Stream stream = stream_of_pixel(pixel, sequence, i);
        const Place place = place_of_sample(i, lattice, stream);
        vec3 o;
        vec3 d;
        camera_ray(vec2(float(pixel.x), float(pixel.y)) + place.in_pixel, size, stream, o, d);
        const vec3 light = radiance(o, d, stream);
        const vec4 sum = film[SUMS_A_PIXEL * at] + vec4(place.weight * light, place.weight);
        vec4 noise = film[SUMS_A_PIXEL * at + 1u];
        const float luminance = dot(light, vec3(0.2126f, 0.7152f, 0.0722f));
        const float away = luminance - noise.x;
        noise.x += away / sum.w;
        noise.y += away * (luminance - noise.x);
        film[SUMS_A_PIXEL * at] = sum;
        film[SUMS_A_PIXEL * at + 1u] = noise;
    }
    const float counted = ends_loops_early() ? STEPS_ENDED : lost > 0u ? STEPS_LOST : 1e-3f * float(steps);
    film[SUMS_A_PIXEL * at + 1u] += vec4(0.0f, 0.0f, counted, 1e-3f * float(rays));
}

/// Likewise, for AovSum of runtime/trace. `film`: the weights that meet a surface, their depths, and how far from the
/// middle the nearest sample is; normals; albedos; that sample's node, as two halves, its levels, and steps as above, or
/// none.
void add_aovs(uvec2 pixel, uint at, vec2 size, uvec2 sequence, uint first, uint count, uint lattice) {
    for (uint i = first; i < first + count; ++i) {
        Stream stream = stream_of_pixel(pixel, sequence, i);
        const Place place = place_of_sample(i, lattice, stream);
        vec3 o;
        vec3 d;
        camera_ray(vec2(float(pixel.x), float(pixel.y)) + place.in_pixel, size, stream, o, d);
        Hit hit;
        const bool found = meet_first(o, d, 0.0f, scene.limits.x, false, hit);
        vec4 sum = film[AOVS_A_PIXEL * at];
        const vec2 off = place.in_pixel - vec2(0.5f);
        if (i == 0u || dot(off, off) < sum.z) {
            const uint node = found ? hit.node : NONE;
            sum.z = dot(off, off);
            film[AOVS_A_PIXEL * at + 3u] = vec4(float(node >> 16), float(node & 0xffffu),
                                                found ? float(hit.levels) : 0.0f, film[AOVS_A_PIXEL * at + 3u].w);
        }
        if (found) {
            sum.x += place.weight;
            sum.y += place.weight * dot(o + hit.t * d, xyz_of(scene.direction));
        }
        film[AOVS_A_PIXEL * at] = sum;
        if (!found) continue;
        film[AOVS_A_PIXEL * at + 1u] += vec4((dot(hit.normal, d) > 0.0f ? -place.weight : place.weight) * hit.normal, 0.0f);
        film[AOVS_A_PIXEL * at + 2u] += vec4(place.weight * hit.rgb, 0.0f);
    }
    const float counted = ends_loops_early() ? STEPS_ENDED : lost > 0u ? STEPS_LOST : 0.0f;
    film[AOVS_A_PIXEL * at + 3u] += vec4(0.0f, 0.0f, 0.0f, counted);
}
