// Rays and primitives, in the primitives' own frames. Each meets the first surface within (least, most).

struct Passage {
    float enter, leave;
};

Passage passage(float enter, float leave) {
    Passage result;
    result.enter = enter;
    result.leave = leave;
    return result;
}

Passage both(Passage a, Passage b) {
    return passage(max(a.enter, b.enter), min(a.leave, b.leave));
}

/// The part of a ray between two planes.
Passage between(float least, float most, float origin, float direction) {
    const float rounding = 1e-6f;
    if (abs(direction) < 1e-20f)
        return origin >= least - rounding && origin <= most + rounding ? passage(-FAR, FAR) : passage(FAR, -FAR);
    const float a = (least - origin) / direction, b = (most - origin) / direction;
    return passage(min(a, b), max(a, b));
}

/// Where the ray enters or, seen from inside, leaves; false if that is out of the range.
bool first_end(Passage inside, float least, float most, OUT(float) t, OUT(bool) leaving) {
    leaving = !(inside.enter > least);
    t = leaving ? inside.leave : inside.enter;
    return inside.enter <= inside.leave && t > least && t < most;
}

float outwards(bool leaving, float direction) {
    return leaving == (direction > 0.0f) ? 1.0f : -1.0f;
}

bool meet_triangle(vec3 o, vec3 d, float least, float most, OUT(float) t, OUT(vec3) normal) {
    const float rounding = 1e-6f, root3 = 1.7320508f;
    normal = vec3(0.0f, 0.0f, 1.0f);
    t = -o.z / d.z;
    if (!(t > least && t < most)) return false;
    const float x = o.x + t * d.x, y = o.y + t * d.y;
    return y >= -0.5f - rounding && root3 * abs(x) + y <= 1.0f + rounding;
}

bool meet_plane(vec3 o, vec3 d, float least, float most, OUT(float) t, OUT(vec3) normal) {
    normal = vec3(0.0f, 1.0f, 0.0f);
    t = -o.y / d.y;
    return abs(d.y) > 1e-20f && t > least && t < most;
}

bool meet_cube(vec3 o, vec3 d, float least, float most, OUT(float) t, OUT(vec3) normal) {
    const Passage x = between(-1.0f, 1.0f, o.x, d.x), y = between(-1.0f, 1.0f, o.y, d.y),
                  z = between(-1.0f, 1.0f, o.z, d.z);
    bool leaving;
    normal = vec3(0.0f);
    if (!first_end(both(both(x, y), z), least, most, t, leaving)) return false;
    if (t == (leaving ? x.leave : x.enter))
        normal.x = outwards(leaving, d.x);
    else if (t == (leaving ? y.leave : y.enter))
        normal.y = outwards(leaving, d.y);
    else
        normal.z = outwards(leaving, d.z);
    return true;
}

bool meet_sphere(vec3 o, vec3 d, float least, float most, OUT(float) t, OUT(vec3) normal) {
    const float speed2 = dot(d, d), middle = -dot(o, d) / speed2;
    const vec3 point = o + middle * d;
    const float left = 1.0f - dot(point, point);
    t = 0.0f;
    normal = point;
    if (!(left >= 0.0f)) return false;
    const float reach = sqrt(left / speed2);
    bool leaving;
    if (!first_end(passage(middle - reach, middle + reach), least, most, t, leaving)) return false;
    normal = normalize(point + (leaving ? reach : -reach) * d);
    return true;
}

/// Zero on the cone x^2 + z^2 = y^2.
float cone_form(vec3 a, vec3 b) {
    return a.x * b.x + a.z * b.z - a.y * b.y;
}

/// Within the nappe y >= 0 of the cone x^2 + z^2 <= y^2. The point is the ray's nearest to the apex.
Passage within_cone(vec3 point, vec3 d) {
    const float a = cone_form(d, d), b = cone_form(point, d), c = cone_form(point, point);
    const float discriminant = b * b - a * c;
    if (!(discriminant >= 0.0f)) return passage(FAR, -FAR);
    const float q = -(b + (b < 0.0f ? -sqrt(discriminant) : sqrt(discriminant)));
    if (q == 0.0f && a == 0.0f) return passage(FAR, -FAR);
    const float one = a == 0.0f ? (q > 0.0f ? FAR : -FAR) : q / a, other = q == 0.0f ? 0.0f : c / q;
    if (a >= 0.0f) return passage(min(one, other), max(one, other));
    return d.y < 0.0f ? passage(-FAR, min(one, other)) : passage(max(one, other), FAR);
}

/// Cylinder, frustum and cone: from radius 1 at y = 0 to `top` at y = 1, capped.
bool meet_tapered(float top, vec3 o, vec3 d, float least, float most, OUT(float) t, OUT(vec3) normal) {
    const float taper = 1.0f - top;
    const vec3 origin = vec3(o.x, 1.0f - taper * o.y, o.z), direction = vec3(d.x, -taper * d.y, d.z);
    const float speed2 = dot(direction, direction);
    const bool upright = speed2 < 1e-30f;
    const float middle = upright ? 0.0f : -dot(origin, direction) / speed2;
    const vec3 point = origin + middle * direction;
    t = 0.0f;
    normal = vec3(0.0f, 1.0f, 0.0f);
    if (!(dot(point, point) < 2.1f)) return false; // the rim is the farthest from the apex, sqrt(2)
    const Passage caps = between(0.0f, 1.0f, o.y, d.y);
    Passage side = passage(-FAR, FAR);
    if (!upright) {
        side = within_cone(point, direction);
        side = passage(middle + side.enter, middle + side.leave);
    } else if (cone_form(point, point) > 0.0f) {
        return false;
    }
    bool leaving;
    if (!first_end(both(caps, side), least, most, t, leaving)) return false;
    if (t == (leaving ? caps.leave : caps.enter)) {
        normal.y = outwards(leaving, d.y);
        return true;
    }
    const vec3 at = point + (t - middle) * direction;
    const vec3 slope = vec3(at.x, taper * at.y, at.z);
    if (dot(slope, slope) > 1e-30f) normal = normalize(slope);
    return true;
}

/// The torus about the y axis of radii 1 and 1/4, by steps of its distance.
bool meet_torus(vec3 o, vec3 d, float least, float most, OUT(float) t, OUT(vec3) normal) {
    const int most_steps = 64;
    const float speed = length(d), near_enough = 2e-6f;
    t = 0.0f;
    normal = vec3(0.0f, 1.0f, 0.0f);
    const float speed2 = dot(d, d), middle = -dot(o, d) / speed2;
    const vec3 point = o + middle * d;
    const float left = 1.5625f - dot(point, point); // the ball that holds it has radius 5/4
    if (!(left >= 0.0f)) return false;
    const float reach = sqrt(left / speed2);
    t = max(least, middle - reach);
    const float end = min(most, middle + reach);
    float side = 0.0f; // of the surface where the ray starts
    for (int i = 0; i < most_steps; ++i) {
        const vec3 p = o + t * d;
        const vec2 ring = vec2(length(vec2(p.x, p.z)) - 1.0f, p.y);
        const float distance = length(ring) - 0.25f;
        if (side == 0.0f) side = distance < 0.0f ? -1.0f : 1.0f;
        // Rays begin on surfaces: the first steps lead away.
        if (distance * side < near_enough && i > 1) break;
        t += max(distance * side, near_enough) / speed;
        if (!(t < end)) return false;
    }
    const vec3 p = o + t * d;
    const float out_of_axis = length(vec2(p.x, p.z));
    normal = normalize(p - vec3(p.x, 0.0f, p.z) / max(out_of_axis, 1e-20f));
    return t > least && t < most;
}

#define HAS_KIND(kind) ((KINDS & (1u << (kind))) != 0u)
#define HAS_TAPERED ((KINDS & (1u << KIND_CYLINDER | 1u << KIND_CONE | 1u << KIND_FRUSTUM)) != 0u)

bool meet_primitive(uint kind, float shape, vec3 o, vec3 d, float least, float most, OUT(float) t,
                    OUT(vec3) normal) {
    // What the model lacks is not compiled. Spheres stand for what is cut.
    if (kind == KIND_SPHERE) return meet_sphere(o, d, least, most, t, normal);
    if (HAS_KIND(KIND_CUBE) && kind == KIND_CUBE) return meet_cube(o, d, least, most, t, normal);
    if (HAS_KIND(KIND_TRIANGLE) && kind == KIND_TRIANGLE) return meet_triangle(o, d, least, most, t, normal);
    if (HAS_KIND(KIND_PLANE) && kind == KIND_PLANE) return meet_plane(o, d, least, most, t, normal);
    if (HAS_KIND(KIND_TORUS) && kind == KIND_TORUS) return meet_torus(o, d, least, most, t, normal);
    if (HAS_TAPERED) return meet_tapered(shape, o, d, least, most, t, normal);
    t = 0.0f;
    normal = d;
    return false;
}

/// A triangle of a mesh: Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection" (2013).
bool meet_facet(uint number, vec3 o, vec3 d, float least, float most, OUT(float) t, OUT(vec3) normal, OUT(vec2) uv) {
    const uint first = number * TRIANGLE_SIZE;
    const vec3 size = abs(d);
    const int z = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const int x = (z + 1) % 3, y = (z + 2) % 3;
    vec3 u, v, w; // coordinates of the corners, the ray's axis last
    for (int k = 0; k < 3; ++k) {
        const vec3 corner = xyz_of(triangles(first + uint(k))) - o;
        w[k] = corner[z];
        u[k] = corner[x] - d[x] / d[z] * w[k];
        v[k] = corner[y] - d[y] / d[z] * w[k];
    }
    const vec3 side = vec3(u[2] * v[1] - v[2] * u[1], u[0] * v[2] - v[0] * u[2], u[1] * v[0] - v[1] * u[0]);
    t = 0.0f;
    normal = vec3(0.0f, 0.0f, 1.0f);
    uv = vec2(0.0f);
    if ((side.x < 0.0f || side.y < 0.0f || side.z < 0.0f) && (side.x > 0.0f || side.y > 0.0f || side.z > 0.0f))
        return false;
    const float whole = side.x + side.y + side.z;
    if (whole == 0.0f) return false;
    const vec3 share = side / whole;
    t = dot(share, w) / d[z];
    if (!(t > least && t < most)) return false;
    const vec4 n0 = triangles(first + 3u), n1 = triangles(first + 4u), n2 = triangles(first + 5u);
    const vec3 n = share.x * xyz_of(n0) + share.y * xyz_of(n1) + share.z * xyz_of(n2);
    uv = vec2(dot(share, vec3(triangles(first).w, triangles(first + 1u).w, triangles(first + 2u).w)),
              dot(share, vec3(n0.w, n1.w, n2.w)));
    if (dot(n, n) > 0.0f) normal = normalize(n);
    return true;
}
