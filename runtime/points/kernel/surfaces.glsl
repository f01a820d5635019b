// Random points of surfaces, evenly spread however a map stretches them (PlacedSurface of compiler/chaos).
//
// forms(), four a form: its kind, the upper radius of what tapers, and the most that area grows (0: everywhere alike); then
// columns of the matrix that turns normals and grows with area.

#include "compiler/chaos/forms.glsl"

#define TURN 6.283185307179586f
#define MOST_TRIES 100u

struct Site {
    vec3 place;
    vec3 normal;
};

Site site_of(vec3 place, vec3 normal) {
    Site site;
    site.place = place;
    site.normal = normal;
    return site;
}

vec2 circle_point(float turn) {
    return vec2(cos(TURN * turn), sin(TURN * turn));
}

Site tapered_site(float top, float u, float v, float w) {
    const vec2 out_ = circle_point(v);
    const float discs = 1.0f + top * top, narrowing = 1.0f - top;
    const float at = w * (discs + (1.0f + top) * sqrt(1.0f + narrowing * narrowing));
    if (at < discs) {
        const float radius = (at < 1.0f ? 1.0f : top) * sqrt(u), y = at < 1.0f ? 0.0f : 1.0f;
        return site_of(vec3(radius * out_.x, y, radius * out_.y), vec3(0.0f, 1.0f, 0.0f));
    }
    const float y = narrowing < 1e-6f ? u : (1.0f - sqrt(max(0.0f, 1.0f - narrowing * u * (1.0f + top)))) / narrowing;
    const float radius = 1.0f - narrowing * y;
    return site_of(vec3(radius * out_.x, y, radius * out_.y), normalize(vec3(out_.x, narrowing, out_.y)));
}

Site torus_site(float u, float v, float w) {
    const float tube_radius = 0.25f;
    vec2 tube = circle_point(u);
    if (2.0f * w > 1.0f + tube_radius * tube.x) tube.x = -tube.x;
    const vec2 out_ = circle_point(v);
    const float radius = 1.0f + tube_radius * tube.x;
    return site_of(vec3(radius * out_.x, tube_radius * tube.y, radius * out_.y),
                   vec3(tube.x * out_.x, tube.y, tube.x * out_.y));
}

/// A site of the form, by three numbers of [0, 1).
Site form_site(uint kind, float top, float u, float v, float w) {
    if (kind == FORM_TRIANGLE) {
        const float root = sqrt(u);
        return site_of(vec3(root * (1.0f - v), root * v, 0.0f), vec3(0.0f, 0.0f, 1.0f));
    }
    if (kind == FORM_SPHERE) {
        const float y = 2.0f * u - 1.0f, radius = sqrt(max(0.0f, 1.0f - y * y));
        const vec2 out_ = circle_point(v);
        const vec3 place = vec3(radius * out_.x, y, radius * out_.y);
        return site_of(place, place);
    }
    if (kind == FORM_CUBE) {
        const float a = 2.0f * u - 1.0f, b = 2.0f * v - 1.0f, side = w < 0.5f ? -1.0f : 1.0f;
        const float axis = 3.0f * (w < 0.5f ? 2.0f * w : 2.0f * w - 1.0f);
        if (axis < 1.0f) return site_of(vec3(side, a, b), vec3(1.0f, 0.0f, 0.0f));
        if (axis < 2.0f) return site_of(vec3(b, side, a), vec3(0.0f, 1.0f, 0.0f));
        return site_of(vec3(a, b, side), vec3(0.0f, 0.0f, 1.0f));
    }
    if (kind == FORM_TAPERED) return tapered_site(top, u, v, w);
    return torus_site(u, v, w);
}

/// A place on a surface, before it is mapped. `move`: at first of its source, then its own.
vec3 surface_place(INOUT(uint) move, INOUT(uvec4) random) {
    if (uint(forms(4u * (move - job.orbit.z)).x) == FORM_GROUP) move = chosen(links(move), random);
    const uint first = 4u * (move - job.orbit.z);
    const vec4 form = forms(first), x = forms(first + 1u), y = forms(first + 2u), z = forms(first + 3u);
    Site site;
    for (uint i = 0u; i < MOST_TRIES; ++i) {
        const float u = unit_of(next_random(random)), v = unit_of(next_random(random));
        site = form_site(uint(form.x), form.y, u, v, unit_of(next_random(random)));
        if (form.z == 0.0f) break;
        const vec3 n = site.normal;
        const vec3 grown = vec3(x.x * n.x + y.x * n.y + z.x * n.z, x.y * n.x + y.y * n.y + z.y * n.z,
                                x.z * n.x + y.z * n.y + z.z * n.z);
        if (unit_of(next_random(random)) * form.z <= length(grown)) break;
    }
    return site.place;
}
