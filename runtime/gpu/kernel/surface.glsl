// Points of surfaces: what a path meets, and the light of lamps and of the sky that it shows there (Shader of
// runtime/trace, with the same choices of the same random numbers; comments there say why).

#define MOST_WAITING 16
#define LEAST_COSINE 1e-10f
#define LEAST_LIGHT 1e-10f
#define SHADOW_PIXELS 1e-3f
#define MIRROR_PIXELS 1e-4f

struct Path {
    vec3 origin, direction;
    float least;
    vec3 weight;
    float counts;
    uint surfaces, bounces;
    bool takes_sky;
    Inside inside;
};

/// Where a path has met a surface: all that it keeps of that while a ray is on its way to a light. The fewer
/// registers it takes, the more rays a device has at once.
struct Spot {
    vec3 position, normal, facet, rgb;
    uint material;
    float faded; // Hit's, and the next, too
    vec3 to_far_side;
};

struct Point {
    vec3 position, normal, facet, to_viewer, rgb, to_far_side;
    Material material;
    vec3 mirrored;
    float mirrors, body;
    vec3 through;
};

float largest_of(vec3 v) {
    return max(max(v.x, v.y), v.z);
}

vec4 solid_of(Material material) {
    return vec4(material.absorbed, material.ior);
}

bool is_blurred(Material material) {
    return material.blur > 0.0f && (material.reflection > 0.0f || material.transparency > 0.0f);
}

vec3 colour_of_pane(Material material, vec3 rgb) {
    const float filtering = length(material.absorbed) > 0.0f ? 0.0f : material.filtering;
    return material.transparency * (filtering * rgb + vec3(1.0f - filtering));
}

float least_distance(vec3 point, float pixels) {
    const float distance = length(point);
    float pixel = scene.lens.z;
    if (scene.direction.w == 0.0f) {
        const float depth = dot(point, xyz_of(scene.direction));
        pixel *= depth > 0.0f ? depth * (depth / distance) : distance;
    }
    return max(pixels * pixel, 4e-7f * distance);
}

#include "runtime/gpu/kernel/pattern.glsl"

bool meet_level(float height, vec3 o, vec3 d, float least, float most, OUT(float) t) {
    t = (height - o.y) / d.y;
    return abs(d.y) >= LEAST_COSINE && t > least && t < most;
}

/// The sky that is no light.
vec3 background(vec3 direction) {
    const float height = (dot(direction, xyz_of(scene.sky_axis)) - scene.sky_zenith.w) * scene.sky_horizon.w;
    const float t = height > 0.0f ? min(height, 0.999999f) : 0.0f;
    return mix(xyz_of(scene.sky_horizon), xyz_of(scene.sky_zenith), t);
}

/// Meets a level surface at this height.
void meet_level_at(float t, float height, uint material, INOUT(Hit) hit) {
    hit.t = t;
    hit.normal = vec3(0.0f, 1.0f, 0.0f);
    hit.material = material;
    hit.rgb = xyz_of(materials(material * MATERIAL_SIZE));
    hit.node = NONE - 1u;
    hit.levels = 0u;
    hit.is_level = true;
    hit.level = height;
    hit.pattern_size = 1.0f;
    hit.faded = 0.0f;
    hit.tint = vec4(0.0f, 0.0f, 0.0f, 1.0f);
    hit.to_far_side = vec3(0.0f);
}

/// A material, with what the relief does that a surface has lost.
Material material_at(uint number, float faded) {
    Material material = material_of(number);
    if (PATTERNS && faded > 0.0f)
        roughen_by_relief(faded, material.facing, material.specular, material.roughness, material.blur);
    return material;
}

/// walk(), and the ground.
bool meet_first(vec3 o, vec3 d, float least, float most, bool any, INOUT(Hit) hit) {
    ++rays;
    const bool found = walk(o, d, least, most, any, hit);
    float t;
    const bool ground = scene.ground.y > 0.0f && meet_level(scene.ground.x, o, d, least, found ? hit.t : most, t);
    if (ground) meet_level_at(t, scene.ground.x, scene.visits.z, hit);
    if (PATTERNS && !any && (found || ground)) show_pattern(o, d, hit);
    return found || ground;
}

void share_light(Inside inside, INOUT(Point) point) {
    const Material material = point.material;
    const float cosine = min(1.0f, dot(point.to_viewer, point.facet)), least = scene.limits.y;
    point.mirrors = material.reflection;
    point.body = 1.0f;
    const bool has_coat = material.ior > 1.0f;
    if (has_coat) {
        if (point.mirrors > 0.0f) point.mirrors *= fresnel(relative_ior(inside, solid_of(material)), cosine);
        point.body = 1.0f - point.mirrors > least ? 1.0f - point.mirrors : 0.0f;
    }
    point.mirrored = vec3(point.mirrors);
    if (point.mirrors > 0.0f && material.metallic > 0.0f)
        point.mirrored *= metal_colour(material.metallic, point.rgb, cosine);
    point.through = vec3(0.0f);
    if (!GLASS || !(material.transparency > 0.0f)) return;
    point.through = colour_of_pane(material, point.rgb) * (has_coat ? vec3(point.body) : vec3(1.0f) - point.mirrored);
    if (!(dot(vec3(0.297f, 0.589f, 0.114f), point.through) > least)) point.through = vec3(0.0f);
    point.body *= 1.0f - material.transparency;
}

Spot spot_of(Path path, Hit hit, INOUT(Stream) stream) {
    Spot spot;
    spot.normal = dot(hit.normal, path.direction) > 0.0f ? -hit.normal : hit.normal;
    spot.position = path.origin + hit.t * path.direction;
    spot.facet = spot.normal;
    spot.rgb = hit.rgb;
    spot.material = hit.material;
    spot.faded = hit.faded;
    spot.to_far_side = hit.to_far_side;
    const Material material = material_at(hit.material, hit.faded);
    if (is_blurred(material))
        spot.facet = visible_facet(spot.normal, -path.direction, material.blur, next_place(stream));
    // Exactly on the ground, its own shadow cannot begin on the way to a low sun.
    if (hit.is_level) spot.position.y = hit.level;
    return spot;
}

Point point_of(Path path, Spot spot) {
    Point point;
    point.position = spot.position;
    point.normal = spot.normal;
    point.facet = spot.facet;
    point.to_viewer = -path.direction;
    point.rgb = spot.rgb;
    point.to_far_side = spot.to_far_side;
    point.material = material_at(spot.material, spot.faded);
    share_light(path.inside, point);
    return point;
}

/// Where rays from a surface start: off it by what its position may be wrong, to the side where they go.
vec3 start_at(Point point, vec3 direction) {
    const float off = 4e-6f * largest_of(abs(point.position));
    return point.position + (dot(point.normal, direction) < 0.0f ? -off : off) * point.normal;
}

/// Likewise of light that the surface scatters, which leaves a sheet by its other face.
vec3 scattered_from(Point point, vec3 direction) {
    const vec3 place = start_at(point, direction);
    return SHEETS && dot(point.normal, direction) < 0.0f ? place + point.to_far_side : place;
}

/// The share of a light that scatters to the viewer, without its colour. `cosine`: to the light, below 0 behind.
float scattered_to_viewer(Material material, float cosine) {
    return (cosine < 0.0f ? material.translucency : material.diffuse) * lit_cosine(abs(cosine), material.facing);
}

vec3 shine(Point point, vec3 to_light) {
    if (!(point.material.specular > 0.0f)) return vec3(0.0f);
    const vec3 halfway = point.to_viewer + to_light;
    const float glint = dot(halfway, point.normal) / length(halfway);
    const float exponent = 1.0f / point.material.roughness;
    if (!(glint > 0.0f && exponent * (1.0f - glint) < 40.0f)) return vec3(0.0f);
    const float share = point.material.specular * pow(glint, exponent);
    if (!(point.material.metallic > 0.0f)) return vec3(share);
    return share * metal_colour(point.material.metallic, point.rgb, dot(to_light, point.normal));
}

/// A way to a light, and the light that comes along it where nothing is in the way.
struct ToLight {
    vec3 direction;
    float most; // distance of the light
    vec3 light; // that the point shows of it; 0: nothing is to be looked for
    bool sure;  // it comes in any case
};

/// A point of a lamp, by chance where it has an area; the direction of a sun.
vec3 place_in(Lamp lamp, INOUT(Stream) stream) {
    const vec3 at = xyz_of(lamp.at);
    if (!(lamp.b.w > 0.0f)) return at;
    vec2 place = next_place(stream);
    if (lamp.a.w > 0.0f) {
        const float radius = sqrt(place.x), turn = 2.0f * PI * place.y;
        place = vec2(radius * cos(turn), radius * sin(turn));
    } else {
        place = 2.0f * place - vec2(1.0f);
    }
    const vec3 chosen = at + place.x * xyz_of(lamp.a) + place.y * xyz_of(lamp.b);
    return lamp.at.w > 0.0f ? normalize(chosen) : chosen;
}

/// Of a lamp or a sun.
ToLight to_lamp(uint number, Point point, float least, INOUT(Stream) stream) {
    const Lamp lamp = scene.lamps[number];
    const vec3 at = place_in(lamp, stream);
    const bool sun = lamp.at.w > 0.0f, shadowless = lamp.rgb.w > 0.0f;
    ToLight to;
    to.direction = at;
    to.most = FAR;
    if (!sun) {
        const vec3 way = at - point.position;
        const float distance = length(way);
        to.direction = way / distance;
        to.most = distance - least;
    }
    to.sure = shadowless;
    const float cosine = dot(point.normal, to.direction);
    const bool behind = cosine < 0.0f;
    vec3 share = point.body * scattered_to_viewer(point.material, cosine) * point.rgb;
    if (!shadowless && !behind) share += shine(point, to.direction);
    // Also if the cosine is not a number, as of a light that lies on the surface.
    const bool any = abs(cosine) >= LEAST_COSINE && largest_of(share) > 0.0f;
    to.light = any ? share * xyz_of(lamp.rgb) : vec3(0.0f);
    return to;
}

/// Of the sky, in a direction that the surface chooses, or one where the sky is bright; over the density of
/// both. `shine_only`: without what is scattered.
ToLight to_sky(bool by_brightness, Point point, bool shine_only, INOUT(Stream) stream) {
    const float body = shine_only ? 0.0f : point.body;
    const float front = body * point.material.diffuse + point.material.specular;
    const float back = body * point.material.translucency;
    ToLight to;
    to.direction = point.normal;
    to.most = FAR;
    to.light = vec3(0.0f);
    to.sure = false;
    if (!(front + back > 0.0f)) return to;
    const float front_chance = front / (front + back);
    const bool shines = point.material.specular > 0.0f;
    const vec2 place = next_place(stream);
    to.direction = by_brightness ? bright_sky_direction(place) : sky_choice(front_chance, shines, point.normal, place);
    const float along = dot(point.normal, to.direction);
    if (!(abs(along) >= LEAST_COSINE)) return to;
    const bool behind = along < 0.0f;
    vec3 share = body * scattered_to_viewer(point.material, along) * point.rgb;
    if (!behind && shines) share += shine(point, to.direction);
    if (!(largest_of(share) > 0.0f)) return to;
    float density_pi = sky_choice_density_pi(front_chance, shines, along);
    if (has_bright_sky()) density_pi += PI * bright_sky_density(to.direction);
    if (density_pi > 0.0f) to.light = share / density_pi * sky_light(to.direction);
    return to;
}
