// What a ray has met: its look and its normal, along the way to it.

struct Hit {
    float t;
    vec3 normal; // in the world, of unit length
    vec3 rgb;    // opaque, with all tints in front
    uint material;
    uint node;     // the last on the way that is no primitive
    uint levels;   // that the way has used up
    bool is_level; // it lies exactly at this height
    float level;
    float pattern_size; // of the part, for a pattern of its material; 0: shows none
    float faded;        // mean square slope, along one axis, of a relief too fine to be seen
    vec4 tint;          // in front of its own colour, with the share that is open to that
    vec3 to_far_side;   // SurfaceHit's, where SHEETS
};

/// The point of a surface for its picture.
struct Site {
    uint kind;  // of the primitive
    vec3 point; // in its frame
    vec2 uv;    // of a mesh
};

float turn_about_y(vec3 point) {
    return atan(point.x, point.z) / (2.0f * PI);
}

/// The place in the picture that is wrapped round the primitive of a part (PrimitiveTraits::texture_point).
vec2 texture_place(Site site, float around, uint part) {
    const vec3 p = site.point;
    if (site.kind == KIND_MESH) {
        const vec4 repeats = nodes(node_of(part) * NODE_SIZE + NODE_LOOK);
        return site.uv * vec2(repeats.y > 0.0f ? around : 1.0f, repeats.z > 0.0f ? around : 1.0f);
    }
    if (site.kind == KIND_TRIANGLE) return vec2(0.5f + p.x / 1.7320508f, (p.y + 0.5f) / 1.5f);
    if (site.kind == KIND_CUBE) return 0.5f * vec2(p.x + 1.0f, p.y + 1.0f);
    const float u = around * turn_about_y(p);
    if (site.kind == KIND_SPHERE) return vec2(u, 0.5f + asin(clamp(p.y / length(p), -1.0f, 1.0f)) / PI);
    if (site.kind == KIND_TORUS) return vec2(u, atan(p.y, length(vec2(p.x, p.z)) - 1.0f) / (2.0f * PI));
    const float turns = looks(part * LOOK_SIZE + 1u).x; // length_in_turns()
    return vec2(u, clamp(floor(around * turns + 0.5f), 1.0f, 1e6f) * p.y);
}

float linear_of_srgb(float level) {
    return level <= 0.04045f ? level / 12.92f : pow((level + 0.055f) / 1.055f, 2.4f);
}

/// The texel of a material's picture: its light, and 1 where it is clear.
vec4 texel_of(uint material, Site site, uint part) {
    const vec4 picture = materials(material * MATERIAL_SIZE + 5u);
    const vec2 place = texture_place(site, picture.w, part);
    const vec2 within = place - floor(place);
    const float x = min(floor(within.x * picture.y), picture.y - 1.0f),
                y = picture.z - 1.0f - min(floor(within.y * picture.z), picture.z - 1.0f);
    const uint word = word_of(texels(bits_of(picture).x + uint(y) * uint(picture.y) + uint(x)));
    const float step = 1.0f / 255.0f;
    return vec4(linear_of_srgb(step * float(word & 255u)), linear_of_srgb(step * float(word >> 8 & 255u)),
                linear_of_srgb(step * float(word >> 16 & 255u)), float(word >> 24));
}

bool has_picture(uint material) {
    return PICTURES && bits_of(materials(material * MATERIAL_SIZE + 5u)).x != NONE;
}

/// Whether the surface of a primitive, `part` beyond the way to frame `last`, has none at this site.
bool is_clear(int last, uint part, Site site) {
    uint material = bits_of(parts(part * PART_SIZE + 3u)).z;
    for (int i = last; i > 0 && material == NONE; --i)
        material = bits_of(parts(part_at(i) * PART_SIZE + 3u)).z;
    if (material == NONE || !has_picture(material)) return false;
    return texel_of(material, site, part).w > 0.0f;
}

/// The nearest thing that a ray has met so far. Only at the end of the walk is it worth looking at: most rays meet some
/// that lie behind.
struct Meeting {
    int last;      // frames on the way to it; their marks are in met_marks
    uint part;     // a primitive's: the one beyond that way
    bool is_proxy; // it is the proxy of the last frame's node
    vec3 normal;   // in its own frame
    Site site;     // likewise
    float scale;   // of the last frame
    bool widened;  // it is drawn about as wide as a pixel all round
    bool crushed;  // it is of what is crushed, and the normal in the world, as is what follows
    vec3 to_far_side;
};

MET_MARKS

/// Keeps the way to a meeting beyond frame `last`.
void keep_way(int last) {
    for (int i = 1; i <= last; ++i)
        met_marks[i] = frame_marks[i].z;
}

uint met_part(int at) {
    return met_marks[at] & FRAME_PART;
}

/// The look at the end of the way to a meeting.
void look_along(Meeting meeting, INOUT(Hit) hit) {
    vec4 tint = vec4(0.0f, 0.0f, 0.0f, 1.0f);
    vec3 inherited = xyz_of(materials(0u));
    hit.material = 0u;
    const uint before = bits_of(looks(meeting.part * LOOK_SIZE + 1u)).y;
    hit.node = !meeting.is_proxy && before != NONE ? node_of(before)
               : meeting.last > 0                  ? node_of(met_part(meeting.last))
                                                   : NONE;
    hit.levels = 0u;
    uint above = NONE;
    const int end = meeting.is_proxy ? meeting.last : meeting.last + 1;
    for (int i = 1; i <= end; ++i) {
        const uint step = i <= meeting.last ? met_part(i) : meeting.part;
        const uvec4 facts = bits_of(parts(step * PART_SIZE + 3u));
        if (i > 1 && (met_marks[i - 1] & FRAME_CUT) != 0u &&
            (bits_of(nodes(above * NODE_SIZE + NODE_FACTS)).y & NODE_TERMINAL) != 0u) {
            const vec4 mean = nodes(above * NODE_SIZE + NODE_MEAN);
            inherited = xyz_of(mean) + mean.w * inherited;
        }
        hit.levels += facts.w & PART_LEVELS;
        const vec4 own = looks(step * LOOK_SIZE);
        tint = vec4(xyz_of(tint) + tint.w * xyz_of(own), tint.w * own.w);
        if (facts.z != NONE) {
            hit.material = facts.z;
            inherited = xyz_of(materials(facts.z * MATERIAL_SIZE));
        }
        above = facts.y;
    }
    if (meeting.is_proxy) {
        const uint node = hit.node;
        const vec4 mean = nodes(node * NODE_SIZE + NODE_STANDIN);
        inherited = xyz_of(mean) + mean.w * inherited;
        const uint finish = bits_of(nodes(node * NODE_SIZE + NODE_LOOK)).x;
        if (finish != NONE) hit.material = finish;
    } else if (has_picture(hit.material)) {
        inherited = xyz_of(texel_of(hit.material, meeting.site, meeting.part));
    }
    hit.rgb = xyz_of(tint) + tint.w * inherited;
    hit.tint = tint;
}

/// pattern_size() of a primitive that was met last, whose frames are still kept, as long as part_size() says.
float pattern_size_of(Meeting meeting) {
    const uint first = meeting.part * PART_SIZE;
    const vec4 extent = nodes(bits_of(parts(first + 3u)).y * NODE_SIZE + NODE_STANDIN);
    if (extent.w == 0.0f) return 1.0f;
    mat3 map = meeting.scale * inverse_of_part(meeting.part);
    if (STRETCHED) map = spaces[meeting.last] * map;
    const float a = extent.x * length(map[0]), b = extent.y * length(map[1]), c = extent.z * length(map[2]);
    const float middle = max(min(a, b), min(max(a, b), c));
    return middle > 0.0f && middle < FAR ? exp2(0.5f * floor(2.0f * log2(middle) + 0.5f)) : 1.0f;
}

/// A point of a part in the frame that holds it.
vec3 point_above(uint part, vec3 point) {
    return inverse_of_part(part) * point + origin_of(part);
}

/// The limit's normal where the proxy of a node is met (limit_normal() of runtime/trace).
vec3 limit_normal(Meeting meeting) {
    const int most_levels = LIMIT_LEVELS;
    vec3 sum = normalize(meeting.normal), point = meeting.site.point;
    int level = 0;
    float weight = 1.0f;
    for (int i = meeting.last; i > 0; --i) {
        // Parts that stand for two are taken apart, the last first.
        for (uint part = met_part(i), before; part != NONE; part = before) {
            const uvec4 passed = bits_of(looks(part * LOOK_SIZE + 1u));
            before = passed.y;
            const uint step = before == NONE ? part : passed.z;
            const float size = length(sum);
            if (!(size > 0.0f)) return meeting.normal;
            sum = size * normal_above(step, sum / size);
            if ((i == 1 && before == NONE) || level == most_levels) continue;
            point = point_above(step, point);
            const uint node = node_of(before == NONE ? met_part(i - 1) : before);
            if ((bits_of(nodes(node * NODE_SIZE + NODE_FACTS)).y & NODE_UNENDING) == 0u) continue;
            ++level;
            weight /= LIMIT_RATIO;
            const vec4 ball = nodes(node * NODE_SIZE + NODE_BALL);
            if (ball.w > 0.0f) sum += weight / ball.w * (point - xyz_of(ball));
        }
    }
    return sum;
}

/// limit_normal_in_world() of runtime/trace, for what is drawn wider than it is. `normal`: its own; `place`: where the
/// ray meets it.
vec3 limit_normal_in_world(Meeting meeting, vec3 normal, vec3 place) {
    const int most_levels = LIMIT_LEVELS;
    mat3 space = mat3(1.0f); // to the world from within the part
    vec3 middle = vec3(0.0f);
    for (int i = 1; i <= meeting.last; ++i) {
        middle += space * origin_of(met_part(i));
        space = space * inverse_of_part(met_part(i));
    }
    vec3 sum = normal;
    int level = 0;
    float weight = 1.0f;
    for (int i = meeting.last; i > 0; --i) {
        for (uint part = met_part(i), before; part != NONE && level < most_levels; part = before) {
            const uvec4 passed = bits_of(looks(part * LOOK_SIZE + 1u));
            before = passed.y;
            if (i == 1 && before == NONE) break;
            const uint step = before == NONE ? part : passed.z, first = step * PART_SIZE;
            space = space * transpose(mat3(xyz_of(parts(first)), xyz_of(parts(first + 1u)), xyz_of(parts(first + 2u))));
            middle -= space * origin_of(step);
            const uint node = node_of(before == NONE ? met_part(i - 1) : before) * NODE_SIZE;
            if ((bits_of(nodes(node + NODE_FACTS)).y & NODE_UNENDING) == 0u) continue;
            ++level;
            weight /= LIMIT_RATIO;
            const vec4 ball = nodes(node + NODE_BALL);
            const float radius = largest_stretch(space) * ball.w;
            if (radius > 0.0f) sum += weight / radius * (place - middle - space * xyz_of(ball));
        }
    }
    return sum;
}

/// From the face of a sheet that was met to the other; 0 where it is none (Traversal::to_far_side_at_best()). `map`: to the
/// world, of the primitive of that node, or its proxy.
vec3 to_far_side(mat3 map, uint node, bool is_proxy, bool wide, vec3 direction) {
    const bool is_solid = is_proxy || (bits_of(nodes(node + NODE_FACTS)).y & NODE_SOLID) != 0u;
    if (!is_solid) return vec3(0.0f);
    const vec3 half_extents = is_proxy ? vec3(1.0f) : xyz_of(nodes(node + NODE_STANDIN));
    vec3 normal;
    const float thickness = sheet_thickness(map[0], map[1], map[2], 2.0f * half_extents, wide, normal);
    return thickness < 0.0f ? vec3(0.0f) : (dot(normal, direction) < 0.0f ? -thickness : thickness) * normal;
}

mat3 map_from_proxy(uint node) {
    return inverse_of(xyz_of(nodes(node + NODE_PROXY)), xyz_of(nodes(node + NODE_PROXY + 1u)),
                      xyz_of(nodes(node + NODE_PROXY + 2u)));
}

/// The linear part of the map to the world of what was met.
mat3 map_of(Meeting meeting) {
    mat3 map = meeting.is_proxy ? map_from_proxy(node_of(meeting.part) * NODE_SIZE) : inverse_of_part(meeting.part);
    for (int i = meeting.last; i > 0; --i)
        map = inverse_of_part(met_part(i)) * map;
    return map;
}

/// Shows what the ray has met.
void take_hit(Meeting meeting, vec3 origin, vec3 direction, INOUT(Hit) hit) {
    hit.is_level = false;
    look_along(meeting, hit);
    vec3 n = meeting.normal;
    const bool widened = FAINTS && meeting.widened;
    if (CRUSHES && meeting.crushed) {
        // As it is.
    } else if (meeting.is_proxy && !widened) {
        n = limit_normal(meeting);
    } else {
        n = meeting.is_proxy ? normalize(n) : normal_above(meeting.part, n);
        for (int i = meeting.last; i > 0; --i)
            n = normal_above(met_part(i), n);
        if (meeting.is_proxy) n = limit_normal_in_world(meeting, n, origin + hit.t * direction);
    }
    const float length2 = dot(n, n);
    hit.normal = length2 > 0.0f ? n * inversesqrt(length2) : vec3(0.0f, 1.0f, 0.0f);
    hit.to_far_side = vec3(0.0f);
    if (!SHEETS || !(materials(hit.material * MATERIAL_SIZE + 2u).x > 0.0f)) return;
    if (CRUSHES && meeting.crushed)
        hit.to_far_side = meeting.to_far_side;
    else if (!widened)
        hit.to_far_side =
            to_far_side(map_of(meeting), node_of(meeting.part) * NODE_SIZE, meeting.is_proxy, false, direction);
}
