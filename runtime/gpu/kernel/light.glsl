// The light along a ray: Shader of runtime/trace, surface by surface, with the same choices of the same random
// numbers. Comments there say why.

#include "runtime/gpu/kernel/surface.glsl"

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

HazeWay way_in_haze(vec3 o, vec3 d) {
    HazeWay way;
    const bool even = scene.haze.z == 0.0f;
    way.begin = even ? 0.0f : (o.y - scene.haze.y) / scene.haze.z;
    way.rise = even ? 0.0f : d.y;
    way.height = even ? 1.0f : scene.haze.z;
    way.distance = scene.haze.x;
    return way;
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
    bool to_light = false, ends = false;
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
            ends = false;
        }
        Hit hit;
        const bool any = to_light && !GLASS;
        const float farthest = min(most, scene.limits.x);
        const bool found = meet_first(from, towards, least, farthest, any, hit);
        bool is_new = false, in_shaft = false;
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
                const HazeWay air = way_in_haze(path.origin, path.direction);
                const float left = left_after_haze(air, way);
                vec3 shown = (1.0f - left) * path.weight * xyz_of(scene.haze_rgb);
                if (scene.haze.w > 0.0f && path.bounces == 0u) {
                    // A ray from somewhere on the way tells whether the sun is seen there (Shader::light_of_haze()).
                    const Lamp sun = scene.lamps[scene.counts.x];
                    towards = place_in(sun, stream);
                    from = path.origin + length_of_haze_share(air, way, next_place(stream).x) * path.direction;
                    light = scene.haze.w * forward_scattering(dot(path.direction, towards)) * shown;
                    shown *= 1.0f - scene.haze.w;
                    in_shaft = !(sun.rgb.w > 0.0f);
                    if (!in_shaft) shown += light;
                    least = least_distance(from, SHADOW_PIXELS);
                    most = FAR;
                    inside = path.inside;
                    panes = 0;
                }
                sum += shown;
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
        to_light = in_shaft;
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
        ends = ends || !(path.surfaces < uint(scene.limits.w) + bounces && path.counts >= scene.limits.y);
        if (!ends) continue;
        if (waiting == 0) break;
        --waiting;
        path = waiting_paths[waiting];
    }
    return is_finite(sum) ? sum : vec3(0.0f);
}
