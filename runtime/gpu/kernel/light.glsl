// The light along a ray: Shader of runtime/trace, surface by surface, with the same choices of the same random
// numbers. Comments there say why.

#define MOST_SURFACES 32u
#define MOST_WAITING 4
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

/// Of a lamp or a sun, by a point of it that is chosen where it has an area.
ToLight to_lamp(uint number, Point point, float least, INOUT(Stream) stream) {
    const Lamp lamp = scene.lamps[number];
    vec3 at = xyz_of(lamp.at);
    const bool sun = lamp.at.w > 0.0f, shadowless = lamp.rgb.w > 0.0f;
    if (lamp.b.w > 0.0f) {
        vec2 place = next_place(stream);
        if (lamp.a.w > 0.0f) {
            const float radius = sqrt(place.x), turn = 2.0f * PI * place.y;
            place = vec2(radius * cos(turn), radius * sin(turn));
        } else {
            place = 2.0f * place - vec2(1.0f);
        }
        at += place.x * xyz_of(lamp.a) + place.y * xyz_of(lamp.b);
        if (sun) at = normalize(at);
    }
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

/// A ray's way on from a surface.
struct Way {
    vec3 share;
    float counts;
    vec3 direction;
};

void roughen(INOUT(Way) way, vec3 normal, float blur) {
    if (!(way.counts > 0.0f)) return;
    const float left = unhidden(dot(normalize(way.direction), normal), blur);
    way.share *= left;
    way.counts *= left;
}

bool lead(Way way, Point point, INOUT(Path) path) {
    if (!(way.counts > 0.0f)) return false;
    path.weight *= way.share;
    path.counts *= way.counts;
    path.direction = normalize(way.direction);
    path.origin = start_at(point, path.direction);
    return is_finite(path.direction);
}

WAITING_PATHS

/// The way on from a surface, backwards along the light (Shader::goes_on()).
bool goes_on(INOUT(Path) path, Point point, float scattered, bool sky_later, INOUT(Stream) stream,
             INOUT(int) waiting) {
    const float along = dot(point.to_viewer, point.facet);
    Way mirror;
    mirror.share = point.mirrored;
    mirror.counts = point.mirrors;
    mirror.direction = 2.0f * along * point.facet - point.to_viewer;
    Way pane;
    pane.share = point.through;
    pane.counts = GLASS ? largest_of(point.through) : 0.0f;
    pane.direction = vec3(0.0f);
    Inside beyond = path.inside;
    if (pane.counts > 0.0f) {
        const float ratio = cross_surface(beyond, solid_of(point.material));
        const float square = 1.0f + ratio * ratio * (along * along - 1.0f);
        if (square < 0.0f) {
            mirror.share = vec3(1.0f);
            mirror.counts = pane.counts;
            pane.counts = 0.0f;
        } else {
            pane.direction = (ratio * along - sqrt(square)) * point.facet - ratio * point.to_viewer;
        }
    }
    if (is_blurred(point.material)) {
        roughen(mirror, point.normal, point.material.blur);
        roughen(pane, -point.normal, point.material.blur);
    }
    const bool both_ways = mirror.counts > 0.0f && pane.counts > 0.0f;
    if (scattered > 0.0f || (both_ways && (path.bounces > 0u || waiting == MOST_WAITING))) {
        const vec2 chosen = next_place(stream);
        const float all = mirror.counts + pane.counts + scattered;
        const float going_on = sky_later ? 1.0f : min(1.0f, all);
        if (chosen.x >= going_on) return false;
        const float mirror_chance = going_on * mirror.counts / all, pane_chance = going_on * pane.counts / all;
        const float scatter_chance = scattered > 0.0f ? going_on - mirror_chance - pane_chance : 0.0f;
        if (chosen.x < scatter_chance) {
            path.counts *= scattered / scatter_chance;
            path.takes_sky = sky_later;
            const float through = point.material.translucency, diffuse = point.material.diffuse + through;
            path.weight *= point.body * diffuse * lit_from_all_sides(point.material.facing) / scatter_chance * point.rgb;
            const vec3 pole = chosen.y * diffuse < through ? -point.normal : point.normal;
            path.direction = cosine_direction(pole, next_place(stream));
            path.origin = scattered_from(point, path.direction);
            ++path.bounces;
            return is_finite(path.direction);
        }
        const bool mirrors = !(pane_chance > 0.0f) || chosen.x < scatter_chance + mirror_chance;
        const float chance = mirrors ? mirror_chance : pane_chance;
        if (mirrors) {
            mirror.share /= chance;
            mirror.counts /= chance;
            pane.counts = 0.0f;
        } else {
            pane.share /= chance;
            pane.counts /= chance;
            mirror.counts = 0.0f;
        }
    }
    if (mirror.counts > 0.0f && pane.counts > 0.0f) {
        Path other = path;
        ++other.surfaces;
        other.least = least_distance(point.position, MIRROR_PIXELS);
        if (lead(mirror, point, other) && other.counts >= scene.limits.y) {
            waiting_paths[waiting] = other;
            ++waiting;
        }
    }
    if (pane.counts > 0.0f) {
        path.inside = beyond;
        return lead(pane, point, path);
    }
    return lead(mirror, point, path);
}

/// The share of what lies behind that haze lets through.
float left_after_air(vec3 o, vec3 d, float way) {
    const bool even = scene.haze.z == 0.0f;
    const float begin = even ? 0.0f : (o.y - scene.haze.y) / scene.haze.z;
    const float end = even ? 0.0f : begin + way * d.y / scene.haze.z;
    return left_after_haze(begin, end, way, scene.haze.x);
}

/// The share of a catcher's paper at a point of its plane (ShadowCatcher::opacity()).
float caught_at(vec3 place) {
    const vec2 off = vec2(place.x - scene.catcher.x, place.z - scene.catcher.z) / scene.catcher.w;
    const float inside = max(0.0f, 1.0f - dot(off, off));
    return inside * inside;
}

/// The light along a camera ray. There is one walk for rays of all kinds: each copy would make a kernel of
/// some thousand instructions more. So each round of the loop takes one ray, of the path or from a point of it
/// to a light, and then says which is the next.
vec3 radiance(vec3 o, vec3 d, INOUT(Stream) stream) {
    const uint bounces = scene.counts.w;
    const uint sources = scene.counts.x + (has_sampled_sky() ? has_bright_sky() ? 2u : 1u : 0u);
    Path path;
    path.origin = o;
    path.direction = d;
    path.least = 0.0f;
    path.weight = vec3(1.0f);
    path.counts = 1.0f;
    path.surfaces = 0u;
    path.bounces = 0u;
    path.takes_sky = true;
    path.inside.count = 0;
    if (scene.ground.z > 0.0f && scene.ground.x > 0.0f)
        cross_surface(path.inside, solid_of(material_of(scene.visits.z)));
    int waiting = 0;
    vec3 sum = vec3(0.0f);
    Spot spot;
    spot.position = o;
    spot.normal = spot.facet = spot.rgb = -d;
    spot.material = 0u;
    spot.faded = 0.0f;
    spot.to_far_side = vec3(0.0f);
    float caught = 0.0f;
    uint source = sources;
    // The ray to a light.
    bool to_light = false;
    vec3 light = vec3(0.0f), from = o, towards = d;
    float least = 0.0f, most = FAR;
    Inside inside = path.inside;
    int panes = 0;
    for (;;) {
        if (!to_light) {
            from = path.origin;
            towards = path.direction;
            least = path.least;
            most = FAR;
        }
        Hit hit;
        const bool any = to_light && !GLASS;
        const float farthest = min(most, scene.limits.x);
        const bool found = meet_first(from, towards, least, farthest, any, hit);
        bool ends = false, is_new = false;
        if (to_light) {
            if (!found) {
                sum += light;
            } else if (!any) {
                const int most_panes = 64;
                const Material material = material_of(hit.material);
                if (material.transparency > 0.0f && panes < most_panes) {
                    light *= colour_of_pane(material, hit.rgb) * left_after(inside, hit.t);
                    cross_surface(inside, solid_of(material));
                    from += hit.t * towards;
                    most -= hit.t;
                    least = least_distance(from, SHADOW_PIXELS);
                    ++panes;
                    if (least < most && largest_of(light) >= LEAST_LIGHT) continue;
                    if (!(least < most)) sum += light;
                }
            }
        } else {
            caught = 0.0f;
            float level;
            if (scene.catcher.w > 0.0f && meet_level(scene.catcher.y, path.origin, path.direction, path.least,
                                                     found ? hit.t : scene.limits.x, level)) {
                caught = caught_at(path.origin + level * path.direction);
                if (caught > 0.0f) meet_level_at(level, scene.catcher.y, scene.visits.w, hit);
            }
            if (scene.haze.x > 0.0f) {
                const float way = found || caught > 0.0f ? hit.t : min(scene.limits.x, 1e9f);
                const float left = left_after_air(path.origin, path.direction, way);
                sum += (1.0f - left) * path.weight * xyz_of(scene.haze_rgb);
                path.weight *= left;
            }
            if (found || caught > 0.0f) {
                path.weight *= left_after(path.inside, hit.t);
                spot = spot_of(path, hit, stream);
                source = 0u;
                is_new = true;
            } else {
                if (path.takes_sky) {
                    const bool shown = path.bounces == 0u && scene.sky_axis.w == 0.0f;
                    sum += path.weight * (shown ? background(path.direction) : sky_light(path.direction));
                }
                ends = true;
            }
        }
        to_light = false;
        const Point point = point_of(path, spot);
        const float scattered = path.bounces < bounces && !(caught > 0.0f)
                                    ? point.body * (point.material.diffuse + point.material.translucency) *
                                          lit_from_all_sides(point.material.facing) * largest_of(point.rgb)
                                    : 0.0f;
        const bool sky_later = !has_bright_sky() && path.counts * scattered >= scene.limits.y;
        const float shadow_least = least_distance(point.position, SHADOW_PIXELS);
        if (is_new)
            sum += (caught > 0.0f ? caught : 1.0f) * path.weight * point.body *
                   (point.material.ambient * xyz_of(scene.ambient) + vec3(point.material.emission)) * point.rgb;
        while (!ends && !to_light && source < sources) {
            ToLight to;
            if (source < scene.counts.x)
                to = to_lamp(source, point, shadow_least, stream);
            else
                to = to_sky(source > scene.counts.x, point, sky_later, stream);
            ++source;
            if (!(largest_of(to.light) > 0.0f)) continue;
            light = (caught > 0.0f ? caught : 1.0f) * path.weight * to.light;
            if (to.sure || !(shadow_least < to.most)) {
                sum += light;
                continue;
            }
            to_light = true;
            from = scattered_from(point, to.direction);
            towards = to.direction;
            least = shadow_least;
            most = to.most;
            inside = path.inside;
            panes = 0;
        }
        if (to_light) continue;
        if (!ends && caught > 0.0f) {
            path.weight *= 1.0f - caught;
            path.counts *= 1.0f - caught;
            path.origin = start_at(point, path.direction);
            path.least = least_distance(point.position, MIRROR_PIXELS);
        } else if (!ends) {
            ends = !goes_on(path, point, scattered, sky_later, stream, waiting);
            path.least = least_distance(point.position, path.bounces > 0u ? SHADOW_PIXELS : MIRROR_PIXELS);
        }
        ++path.surfaces;
        ends = ends || !(path.surfaces < MOST_SURFACES + bounces && path.counts >= scene.limits.y);
        if (!ends) continue;
        if (waiting == 0) break;
        --waiting;
        path = waiting_paths[waiting];
    }
    return is_finite(sum) ? sum : vec3(0.0f);
}
