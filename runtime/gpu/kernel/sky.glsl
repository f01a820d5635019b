// The sky's light: SkyLight, ClearSky, SkyPicture and SkySampling of compiler/light.

/// Words of the sky's picture in texels[]: its texels of three floats each, row by row; then the sums of
/// chances by row, and by column within each row.
uint picture_texel(int x, int y) {
    return 3u * (uint(y) * uint(scene.picture_from_world[0].w) + uint(x));
}

vec3 texel_at(int x, int y) {
    const uint first = picture_texel(x, y);
    return vec3(texels(first), texels(first + 1u), texels(first + 2u));
}

vec3 to_picture(vec3 direction) {
    return direction.x * xyz_of(scene.picture_from_world[0]) + direction.y * xyz_of(scene.picture_from_world[1]) +
           direction.z * xyz_of(scene.picture_from_world[2]);
}

/// Where the picture has a direction: to the right and downwards, both in [0, 1].
vec2 place_in_picture(vec3 d) {
    const float u = 0.5f + atan(d.z, d.x) / (2.0f * PI), v = atan(length(vec2(d.x, d.z)), d.y) / PI;
    return vec2(clamp(u, 0.0f, 1.0f), clamp(v, 0.0f, 1.0f));
}

/// The four texels about a place (TexelMix): columns x0 and x1, rows y0 and y1, and the shares of the later.
struct TexelMix {
    int x0, x1, y0, y1;
    float right, down;
};

TexelMix texels_about(vec2 place) {
    const int width = int(scene.picture_from_world[0].w), height = int(scene.picture_from_world[1].w);
    const float x = place.x * float(width) - 0.5f,
                y = clamp(place.y * float(height) - 0.5f, 0.0f, float(height) - 1.0f);
    TexelMix about;
    about.right = x - floor(x);
    about.down = y - floor(y);
    about.x0 = x < 0.0f ? width - 1 : int(x);
    about.x1 = about.x0 + 1 < width ? about.x0 + 1 : 0;
    about.y0 = int(y);
    about.y1 = about.y0 + 1 < height ? about.y0 + 1 : about.y0;
    return about;
}

vec3 light_of_picture(vec3 direction) {
    const TexelMix about = texels_about(place_in_picture(to_picture(direction)));
    return mix(mix(texel_at(about.x0, about.y0), texel_at(about.x1, about.y0), about.right),
               mix(texel_at(about.x0, about.y1), texel_at(about.x1, about.y1), about.right), about.down);
}

vec3 light_of_clear_sky(vec3 direction, float height) {
    const float cos_sun = dot(direction, xyz_of(scene.clear_sun));
    const float cos_zenith = max(height, scene.clear_sun.w);
    const vec4 a = scene.perez[0], b = scene.perez[1], c = scene.perez[2], d = scene.perez[3];
    const vec3 yxy = vec3(perez_at(a.x, a.y, a.z, a.w, b.x, cos_zenith, cos_sun),
                          perez_at(b.y, b.z, b.w, c.x, c.y, cos_zenith, cos_sun),
                          perez_at(c.z, c.w, d.x, d.y, d.z, cos_zenith, cos_sun));
    return light_of_yxy(xyz_of(scene.clear_zenith) * yxy);
}

/// SkyLight::radiance().
vec3 sky_light(vec3 direction) {
    const int kind = int(scene.light_up.w);
    if (kind == LIGHT_NONE) return vec3(0.0f);
    const float brightness = scene.light_zenith.w;
    if (kind == LIGHT_PICTURE) return brightness * light_of_picture(direction);
    const float height = dot(direction, xyz_of(scene.light_up));
    if (height < 0.0f) return xyz_of(scene.light_below);
    if (kind == LIGHT_CLEAR) return brightness * light_of_clear_sky(direction, height);
    return mix(xyz_of(scene.light_horizon), xyz_of(scene.light_zenith), min(height / scene.light_horizon.w, 1.0f));
}

bool has_sampled_sky() {
    return int(scene.light_up.w) != LIGHT_NONE;
}

bool has_bright_sky() {
    return scene.picture_from_world[2].w > 0.0f;
}

/// Where the sums of chances begin in texels[]: those of rows, and those of the columns within a row.
uint row_sums() {
    return picture_texel(0, int(scene.picture_from_world[1].w));
}

uint column_sums(int row) {
    return row_sums() + uint(scene.picture_from_world[1].w) + uint(row) * uint(scene.picture_from_world[0].w);
}

float sum_before(uint sums, int number) {
    return number > 0 ? texels(sums + uint(number) - 1u) : 0.0f;
}

float chance_of(uint sums, int number) {
    return texels(sums + uint(number)) - sum_before(sums, number);
}

/// The number between -1 and 1 that one in [0, 1) chooses, with a density of 1 - |x|.
float tent(float place) {
    return place < 0.5f ? sqrt(2.0f * place) - 1.0f : 1.0f - sqrt(2.0f * (1.0f - place));
}

/// The first of `count` numbers whose sum is above a place in [0, 1), and a place about its middle by chance.
float chosen_by(uint sums, int count, float place, OUT(int) number) {
    int low = 0, high = count - 1;
    while (low < high) {
        const int middle = (low + high) / 2;
        if (texels(sums + uint(middle)) > place)
            high = middle;
        else
            low = middle + 1;
    }
    number = low;
    const float begin = sum_before(sums, number);
    const float share = clamp((place - begin) / (texels(sums + uint(number)) - begin), 0.0f, 1.0f);
    return float(number) + 0.5f + tent(share);
}

/// A direction by chance, by SkySampling::direction().
vec3 bright_sky_direction(vec2 place) {
    const int width = int(scene.picture_from_world[0].w), height = int(scene.picture_from_world[1].w);
    int row;
    int column;
    float v = abs(chosen_by(row_sums(), height, place.y, row) / float(height));
    const float u = chosen_by(column_sums(row), width, place.x, column) / float(width);
    if (v > 1.0f) v = 2.0f - v;
    const float y = cos(PI * v), turn = 2.0f * PI * (u - 0.5f), radius = sqrt(max(0.0f, 1.0f - y * y));
    const vec3 d = vec3(radius * cos(turn), y, radius * sin(turn));
    // The turn is orthogonal: its transpose takes it back.
    return vec3(dot(xyz_of(scene.picture_from_world[0]), d), dot(xyz_of(scene.picture_from_world[1]), d),
                dot(xyz_of(scene.picture_from_world[2]), d));
}

/// The density of that, a steradian.
float bright_sky_density(vec3 direction) {
    const vec3 d = to_picture(direction);
    const TexelMix about = texels_about(place_in_picture(d));
    const uint first = column_sums(about.y0), second = column_sums(about.y1);
    const float high = chance_of(row_sums(), about.y0) *
                       mix(chance_of(first, about.x0), chance_of(first, about.x1), about.right);
    const float low = chance_of(row_sums(), about.y1) *
                      mix(chance_of(second, about.x0), chance_of(second, about.x1), about.right);
    const float sine = max(length(vec2(d.x, d.z)), 1e-6f);
    return mix(high, low, about.down) * scene.picture_from_world[0].w * scene.picture_from_world[1].w /
           (2.0f * PI * PI * sine);
}
