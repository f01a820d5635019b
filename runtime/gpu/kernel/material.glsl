// Materials, and the solids that a ray is in.

#define MOST_SOLIDS 4

struct Material {
    vec3 rgb;
    float ambient, diffuse, specular, roughness, reflection, translucency, emission, metallic, transparency;
    float filtering, ior, blur;
    float facing; // facing_of_relief()
    vec3 absorbed; // optical depth of a unit of length within
};

Material material_of(uint number) {
    const uint first = number * MATERIAL_SIZE;
    const vec4 a = materials(first), b = materials(first + 1u), c = materials(first + 2u),
               d = materials(first + 3u), e = materials(first + 4u);
    Material material;
    material.rgb = xyz_of(a);
    material.ambient = a.w;
    material.diffuse = b.x;
    material.specular = b.y;
    material.roughness = max(b.z, 5e-4f); // the least that is emitted
    material.reflection = b.w;
    material.translucency = c.x;
    material.emission = c.y;
    material.metallic = c.z;
    material.transparency = c.w;
    material.filtering = d.x;
    material.ior = d.y;
    material.blur = d.z;
    material.facing = 1.0f;
    material.absorbed = xyz_of(e);
    return material;
}

/// The solids that a ray is in: the index of each and what it absorbs, the one entered last at the end.
struct Inside {
    vec4 solids[MOST_SOLIDS];
    int count;
};

int place_in(Inside inside, vec4 solid) {
    for (int i = 0; i < MOST_SOLIDS; ++i)
        if (i < inside.count && inside.solids[i] == solid) return i;
    return -1;
}

float last_ior(Inside inside) {
    return inside.count == 0 ? 1.0f : inside.solids[inside.count - 1].w;
}

float relative_ior(Inside inside, vec4 solid) {
    if (!GLASS || inside.count == 0) return solid.w;
    if (place_in(inside, solid) < 0) return solid.w / last_ior(inside);
    return (inside.count == 1 ? 1.0f : last_ior(inside)) / solid.w;
}

float cross_surface(INOUT(Inside) inside, vec4 solid) {
    if (!GLASS) return 1.0f;
    const int known = place_in(inside, solid);
    if (known >= 0) {
        const bool innermost = known == inside.count - 1;
        for (int i = known; i + 1 < inside.count; ++i)
            inside.solids[i] = inside.solids[i + 1];
        --inside.count;
        return innermost ? solid.w / last_ior(inside) : 1.0f;
    }
    const float outer = last_ior(inside);
    if (inside.count == MOST_SOLIDS) return 1.0f;
    inside.solids[inside.count] = solid;
    ++inside.count;
    return outer / solid.w;
}

vec3 left_after(Inside inside, float length_of_way) {
    if (!GLASS) return vec3(1.0f);
    vec3 depth = vec3(0.0f);
    for (int i = 0; i < inside.count; ++i)
        depth += xyz_of(inside.solids[i]);
    return depth == vec3(0.0f) ? vec3(1.0f) : exp(-length_of_way * depth);
}
