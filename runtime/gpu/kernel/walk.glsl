// Rays through the cyclic graph itself, depth first and the nearest first, into the frame of each part, as deep
// as the parts are that the view shows (Traversal of runtime/trace does the same in doubles).

// MOST_FRAMES lie on the way from the root, and MOST_LATER entries wait. A ray that needs more counts as lost.

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
    vec4 tint;          // in front of its own colour, with the share that is open to that
};

/// A place on the way, and the ray there: origin + (t - base) / unit * direction.
struct Frame {
    vec3 origin;
    vec3 low;     // what the origin has lost by rounding, where PAIRED
    float base;
    vec3 direction;
    float unit;
    float scale;  // norm of the map to the world; the unit, unless STRETCHED
    float margin; // by which parts may reach out of their boxes, where FAINTS
    uint steps;   // levels that are left
    uint part;    // the last on the way
    int waiting;  // entries that waited when the ray came here
    bool cut;     // drawn by what stands for its parts
    bool faint;   // what is drawn stands for a set without area
};

/// Half of what is drawn at least of a set without area, about a point of the world: Projection's
/// least_half_width(), or most_half_width() with a negative radius.
float least_half_width(vec3 from_eye, float radius) {
    if (scene.projection.w == 0.0f) return 0.0f;
    if (scene.projection.z > 0.0f) return scene.projection.z;
    if (scene.direction.w > 0.0f) return scene.widths.x / scene.projection.x;
    const float distance = max(dot(from_eye, xyz_of(scene.direction)), 0.5f * length(from_eye));
    return scene.widths.x * max(distance - radius, scene.projection.y) / scene.projection.x;
}

/// The detail of a length of 1 about a point of the world: Projection::detail_per_unit().
float detail_per_unit(vec3 from_eye, float radius) {
    if (scene.projection.w == 0.0f) return FAR;
    const float aside = abs(dot(from_eye, xyz_of(scene.right))), above = abs(dot(from_eye, xyz_of(scene.up)));
    const bool parallel = scene.direction.w > 0.0f;
    const float along = dot(from_eye, xyz_of(scene.direction)), depth = parallel ? 1.0f : along;
    const bool seen = aside * scene.edges.y - depth * scene.edges.x <= radius &&
                      above * scene.edges.w - depth * scene.edges.z <= radius && (parallel || along >= -radius);
    const float coarser = seen ? 1.0f : 8.0f;
    if (scene.projection.z > 0.0f) return 1.0f / (scene.projection.z * coarser);
    if (parallel) return scene.projection.x / coarser;
    const float distance = max(along, 0.5f * length(from_eye));
    return scene.projection.x / (max(distance - radius, scene.projection.y) * coarser);
}

/// At most the detail of a length of 1 anywhere so far about that point.
float least_detail_per_unit(vec3 from_eye, float reach) {
    if (scene.projection.w == 0.0f) return FAR;
    const float aside = abs(dot(from_eye, xyz_of(scene.right))), above = abs(dot(from_eye, xyz_of(scene.up)));
    const bool parallel = scene.direction.w > 0.0f;
    const float along = dot(from_eye, xyz_of(scene.direction)), depth = parallel ? 1.0f : along;
    const bool seen = aside * scene.edges.y - depth * scene.edges.x <= -2.0f * reach &&
                      above * scene.edges.w - depth * scene.edges.z <= -2.0f * reach && (parallel || along >= reach);
    const float coarser = seen ? 1.0f : 8.0f;
    if (scene.projection.z > 0.0f) return 1.0f / (scene.projection.z * coarser);
    if (parallel) return scene.projection.x / coarser;
    const float distance = max(along, 0.5f * length(from_eye)) + reach;
    return scene.projection.x / (max(distance, scene.projection.y) * coarser);
}

vec3 rows_transposed(vec4 a, vec4 b, vec4 c, vec3 v) {
    return v.x * xyz_of(a) + v.y * xyz_of(b) + v.z * xyz_of(c);
}

FRAMES

#define FRAME_CUT (1u << 31)
#define FRAME_FAINT (1u << 30)
#define FRAME_PART 0x3fffffffu

/// Keeps a frame as number `at`. The fewer words it takes, the more rays a device has room for.
void keep(int at, Frame frame) {
    frame_places[at] = vec4(frame.origin, frame.base);
    const uint marks = (frame.part & FRAME_PART) | (frame.cut ? FRAME_CUT : 0u) | (frame.faint ? FRAME_FAINT : 0u);
    frame_marks[at] = uvec4(word_of(frame.unit), frame.steps, marks, uint(frame.waiting));
    if (!EVEN) frame_directions[at] = frame.direction;
    if (STRETCHED || FAINTS) frame_sizes[at] = vec2(frame.scale, frame.margin);
    if (PAIRED) frame_lows[at] = frame.low;
}

/// The frame kept there. `direction`: of the ray in the world.
Frame kept(int at, vec3 direction) {
    const vec4 place = frame_places[at];
    const uvec4 marks = frame_marks[at];
    Frame frame;
    frame.origin = xyz_of(place);
    frame.low = vec3(0.0f);
    if (PAIRED) frame.low = frame_lows[at];
    frame.base = place.w;
    frame.direction = direction;
    if (!EVEN) frame.direction = frame_directions[at];
    frame.unit = float_of(marks.x);
    frame.scale = frame.unit;
    frame.margin = 0.0f;
    if (STRETCHED || FAINTS) {
        frame.scale = frame_sizes[at].x;
        frame.margin = frame_sizes[at].y;
    }
    frame.steps = marks.y;
    frame.part = marks.z & FRAME_PART;
    frame.waiting = int(marks.w);
    frame.cut = (marks.z & FRAME_CUT) != 0u;
    frame.faint = (marks.z & FRAME_FAINT) != 0u;
    return frame;
}

/// The last part on the way to a kept frame, which is not the first.
uint part_at(int at) {
    return frame_marks[at].z & FRAME_PART;
}

uint node_of(uint part) {
    return bits_of(parts(part * PART_SIZE + 3u)).y;
}

/// A normal of a part in the frame that holds it.
vec3 normal_above(uint part, vec3 normal) {
    const uint first = part * PART_SIZE;
    const vec3 n = rows_transposed(parts(first), parts(first + 1u), parts(first + 2u), normal);
    const float length2 = dot(n, n);
    return length2 > 0.0f ? n * inversesqrt(length2) : normal;
}

/// Rays of the thread, boxes and parts that they went to, and parts that they had no room for.
STEPS

/// The linear parts of the maps from the frames to the world, less the scale, where STRETCHED: the norm of a
/// product of maps that stretch unevenly is no product.
SPACES

/// largest_stretch() of compiler/support.
float largest_stretch(mat3 map) {
    const vec3 a = map[0], b = map[1], c = map[2];
    const float mean = (dot(a, a) + dot(b, b) + dot(c, c)) / 3.0f;
    const float x = dot(a, a) / mean - 1.0f, y = dot(b, b) / mean - 1.0f, z = dot(c, c) / mean - 1.0f;
    const float xy = dot(a, b) / mean, yz = dot(b, c) / mean, zx = dot(c, a) / mean;
    const float p2 = (x * x + y * y + z * z + 2.0f * (xy * xy + yz * yz + zx * zx)) / 6.0f;
    if (!(p2 > 1e-12f)) return sqrt(mean);
    const float p = sqrt(p2);
    const float determinant = x * (y * z - yz * yz) - xy * (xy * z - yz * zx) + zx * (xy * yz - y * zx);
    const float angle = acos(clamp(0.5f * determinant / (p2 * p), -1.0f, 1.0f)) / 3.0f;
    return sqrt(mean * (1.0f + 2.0f * p * cos(angle)));
}

/// The inverse of the matrix of these rows.
mat3 inverse_of(vec3 row0, vec3 row1, vec3 row2) {
    const vec3 x = cross(row1, row2), y = cross(row2, row0), z = cross(row0, row1);
    return mat3(x, y, z) / dot(row0, x);
}

/// The linear map to the world from within a part, by the rows of that into it. `at`: of the frame that holds it, of
/// this scale.
mat3 to_world(int at, float scale, vec3 row0, vec3 row1, vec3 row2) {
    const mat3 part = scale * inverse_of(row0, row1, row2);
    return STRETCHED ? spaces[at] * part : part;
}

/// Half axes of the image of a ball that are shorter than the width become as long: the map by which rays meet
/// that, in the ball's own space (least_width.h). Jacobi's turns find the axes.
mat3 squeezing(mat3 world_from_ball, float width) {
    const mat3 widths = world_from_ball / width;
    mat3 squares = transpose(widths) * widths, axes = mat3(1.0f);
    for (int turn = 0; turn < 12; ++turn) {
        const int p = turn % 3, q = (p + 1) % 3;
        if (!(abs(squares[p][q]) > 1e-7f * sqrt(squares[p][p] * squares[q][q]))) continue;
        const float ratio = 0.5f * (squares[q][q] - squares[p][p]) / squares[p][q];
        const float tangent = (ratio < 0.0f ? -1.0f : 1.0f) / (abs(ratio) + sqrt(ratio * ratio + 1.0f));
        const float cosine = inversesqrt(tangent * tangent + 1.0f);
        mat3 turned = mat3(1.0f);
        turned[p][p] = cosine;
        turned[q][q] = cosine;
        turned[p][q] = -tangent * cosine;
        turned[q][p] = tangent * cosine;
        squares = transpose(turned) * squares * turned;
        axes = axes * turned;
    }
    mat3 shares = mat3(1.0f);
    for (int i = 0; i < 3; ++i)
        shares[i][i] = min(sqrt(max(squares[i][i], 0.0f)), 1.0f);
    return axes * shares * transpose(axes);
}

/// Half of the largest extent along an axis of a frame that a ball of the world has there, which has 1.
float most_extent(mat3 space) {
    const vec3 bc = cross(space[1], space[2]), ca = cross(space[2], space[0]), ab = cross(space[0], space[1]);
    return max(length(bc), max(length(ca), length(ab))) / abs(dot(space[0], bc));
}

/// Places a part, whose map has these rows, into the space of frame `at`, of this scale; the norm of the map to the
/// world.
float place_space(int at, float scale, vec3 row0, vec3 row1, vec3 row2, float stretch) {
    if (at == 0) {
        spaces[1] = mat3(1.0f); // the root's map only scales evenly
        return stretch;
    }
    const mat3 space = spaces[at] * inverse_of(row0, row1, row2) / stretch;
    const float growth = largest_stretch(space);
    spaces[at + 1] = space / growth;
    return scale * stretch * growth;
}

/// A point of frame `at` in the world. Where no space tells how that is turned: the place of the ray nearest to it.
vec3 place_of(vec3 point, Frame frame, int at, vec3 origin, vec3 direction) {
    float along = dot(point - frame.origin, frame.direction);
    if (STRETCHED) along /= dot(frame.direction, frame.direction);
    const vec3 place = origin + (frame.base + along * frame.unit) * direction;
    if (!STRETCHED) return place;
    return place + frame.scale * (spaces[at] * (point - frame.origin - along * frame.direction));
}

/// The point of a surface for its picture.
struct Site {
    uint kind;  // of the primitive
    vec3 point; // in its frame
    vec2 uv;    // of a mesh
};

float turn_about_y(vec3 point) {
    return atan(point.x, point.z) / (2.0f * PI);
}

/// The place in the picture that is wrapped round a primitive (PrimitiveTraits::texture_point). `turns`: its
/// length_in_turns().
vec2 texture_place(Site site, float around, float turns) {
    const vec3 p = site.point;
    if (site.kind == KIND_MESH) return site.uv;
    if (site.kind == KIND_TRIANGLE) return vec2(0.5f + p.x / 1.7320508f, (p.y + 0.5f) / 1.5f);
    if (site.kind == KIND_CUBE) return 0.5f * vec2(p.x + 1.0f, p.y + 1.0f);
    const float u = around * turn_about_y(p);
    if (site.kind == KIND_SPHERE) return vec2(u, 0.5f + asin(clamp(p.y / length(p), -1.0f, 1.0f)) / PI);
    if (site.kind == KIND_TORUS) return vec2(u, atan(p.y, length(vec2(p.x, p.z)) - 1.0f) / (2.0f * PI));
    return vec2(u, clamp(floor(around * turns + 0.5f), 1.0f, 1e6f) * p.y);
}

float linear_of_srgb(float level) {
    return level <= 0.04045f ? level / 12.92f : pow((level + 0.055f) / 1.055f, 2.4f);
}

/// The texel of a material's picture: its light, and 1 where it is clear.
vec4 texel_of(uint material, Site site, float turns) {
    const vec4 picture = materials(material * MATERIAL_SIZE + 5u);
    const vec2 place = texture_place(site, picture.w, turns);
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
    return texel_of(material, site, looks(part * LOOK_SIZE + 1u).x).w > 0.0f;
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
        hit.levels += facts.w;
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
        inherited = xyz_of(texel_of(hit.material, meeting.site, looks(meeting.part * LOOK_SIZE + 1u).x));
    }
    hit.rgb = xyz_of(tint) + tint.w * inherited;
    hit.tint = tint;
}

/// pattern_size() of a primitive that was met last, whose frames are still kept, as long as part_size() says.
float pattern_size_of(Meeting meeting) {
    const uint first = meeting.part * PART_SIZE;
    const vec4 extent = nodes(bits_of(parts(first + 3u)).y * NODE_SIZE + NODE_STANDIN);
    if (extent.w == 0.0f) return 1.0f;
    const mat3 map = to_world(meeting.last, meeting.scale, xyz_of(parts(first)), xyz_of(parts(first + 1u)), xyz_of(parts(first + 2u)));
    const float a = extent.x * length(map[0]), b = extent.y * length(map[1]), c = extent.z * length(map[2]);
    const float middle = max(min(a, b), min(max(a, b), c));
    return middle > 0.0f && middle < FAR ? exp2(0.5f * floor(2.0f * log2(middle) + 0.5f)) : 1.0f;
}

/// A point of a part in the frame that holds it.
vec3 point_above(uint part, vec3 point) {
    const uint first = part * PART_SIZE;
    const vec4 row0 = parts(first), row1 = parts(first + 1u), row2 = parts(first + 2u);
    return inverse_of(xyz_of(row0), xyz_of(row1), xyz_of(row2)) * point + vec3(row0.w, row1.w, row2.w);
}

/// The limit's normal where the proxy of a node is met (limit_normal() of runtime/trace).
vec3 limit_normal(Meeting meeting) {
    const int most_levels = LIMIT_LEVELS;
    vec3 sum = meeting.normal, point = meeting.site.point;
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

/// Shows what the ray has met.
void take_hit(Meeting meeting, INOUT(Hit) hit) {
    hit.is_level = false;
    look_along(meeting, hit);
    vec3 n = meeting.normal;
    if (meeting.is_proxy) {
        n = limit_normal(meeting);
    } else {
        n = normal_above(meeting.part, n);
        for (int i = meeting.last; i > 0; --i)
            n = normal_above(met_part(i), n);
    }
    const float length2 = dot(n, n);
    hit.normal = length2 > 0.0f ? n * inversesqrt(length2) : vec3(0.0f, 1.0f, 0.0f);
}

/// a + b as a pair of floats: Knuth, "The Art of Computer Programming", volume 2, section 4.2.2, theorem B.
void pair_of_sum(vec3 a, vec3 b, OUT(vec3) high, OUT(vec3) low) {
    PRECISE vec3 sum = a + b;
    PRECISE vec3 part = sum - a;
    PRECISE vec3 left = (a - (sum - part)) + (b - part);
    high = sum;
    low = left;
}

/// a b as a pair of floats, by halves (Dekker 1971): not all devices have a product and a sum in one rounding.
void pair_of_product(vec3 a, vec3 b, OUT(vec3) high, OUT(vec3) low) {
    const float splitter = 4097.0f;
    PRECISE vec3 product = a * b;
    PRECISE vec3 a_split = splitter * a, b_split = splitter * b;
    PRECISE vec3 a_high = a_split - (a_split - a), b_high = b_split - (b_split - b);
    PRECISE vec3 a_low = a - a_high, b_low = b - b_high;
    PRECISE vec3 left = ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
    high = product;
    low = left;
}

/// Adds a pair to a pair.
void add_pair(vec3 other, vec3 other_low, INOUT(vec3) high, INOUT(vec3) low) {
    vec3 sum;
    vec3 left;
    pair_of_sum(high, other, sum, left);
    PRECISE vec3 all = left + (low + other_low);
    pair_of_sum(sum, all, high, low);
}

/// The origin of a ray in a part, `along` from that of frame `outer`: errors of rounding would grow with each level.
void place_by_pairs(uint part, Frame outer, float along, INOUT(Frame) inner) {
    vec3 at = outer.origin;
    vec3 at_low = outer.low;
    vec3 product;
    vec3 left;
    pair_of_product(vec3(along), outer.direction, product, left);
    add_pair(product, left, at, at_low);
    const uint first = part * PART_SIZE;
    const vec4 row0 = parts(first), row1 = parts(first + 1u), row2 = parts(first + 2u);
    const vec4 low0 = lows(part * LOW_SIZE), low1 = lows(part * LOW_SIZE + 1u), low2 = lows(part * LOW_SIZE + 2u);
    add_pair(-vec3(row0.w, row1.w, row2.w), -vec3(low0.w, low1.w, low2.w), at, at_low);
    inner.origin = vec3(0.0f);
    inner.low = vec3(0.0f);
    for (int k = 0; k < 3; ++k) {
        const vec3 column = vec3(row0[k], row1[k], row2[k]), column_low = vec3(low0[k], low1[k], low2[k]);
        pair_of_product(column, vec3(at[k]), product, left);
        PRECISE vec3 small = left + (column * at_low[k] + column_low * at[k]);
        add_pair(product, small, inner.origin, inner.low);
    }
}

/// The first surface along the ray, or with `any` whether there is one: then nothing else of the hit counts.
bool walk(vec3 origin, vec3 direction, float least, float most, bool any, INOUT(Hit) hit) {
    uint later_entry[MOST_LATER];
    float later_t[MOST_LATER];
    int later = 0;
    bool found = false;
    bool hurries = false;
    uint visits = 0u;
    hit.t = most;
    hit.pattern_size = 0.0f;
    Meeting meeting;
    Frame frame;
    frame.origin = origin;
    frame.low = vec3(0.0f);
    frame.base = 0.0f;
    frame.direction = direction;
    frame.unit = 1.0f;
    frame.scale = 1.0f;
    frame.margin = scene.widths.z;
    frame.steps = scene.counts.z;
    frame.part = NONE;
    frame.waiting = 0;
    frame.cut = false;
    frame.faint = false;
    keep(0, frame);
    int at = 0; // its number
    uint entry = scene.counts.y;
    float entry_t = 0.0f;
    vec3 reciprocal = 1.0f / never_zero(direction), shift = -frame.origin * reciprocal;
    float per_unit = 1.0f;
    for (;;) {
        bool is_new = false; // the frame
        // Down through boxes, into the nearest first; the others wait.
        while ((entry & ~ENTRY_NUMBER) == 0u) {
            const uint first = entry * BOX_SIZE;
            const float near = (least - frame.base) * per_unit, far = (hit.t - frame.base) * per_unit;
            const float margin = FAINTS ? frame.margin : 0.0f;
            entry = NONE;
            entry_t = FAR;
            ++visits;
            for (uint i = 0u; i < 4u; ++i) {
                const vec4 low = boxes(first + 2u * i), high = boxes(first + 2u * i + 1u);
                const uint child = bits_of(low).w;
                const vec3 a = (xyz_of(low) - margin) * reciprocal + shift,
                           b = (xyz_of(high) + margin) * reciprocal + shift;
                const vec3 enter = min(a, b), leave = max(a, b);
                const float t0 = max(max(enter.x, enter.y), max(enter.z, near));
                const float t1 = min(min(leave.x, leave.y), min(leave.z, far));
                if (child == NONE || !(t0 <= t1 * (1.0f + 4e-7f) + 1e-7f)) continue;
                const float t = frame.base + t0 * frame.unit;
                uint put = child;
                float put_t = t;
                if (t < entry_t) {
                    put = entry;
                    put_t = entry_t;
                    entry = child;
                    entry_t = t;
                }
                if (put != NONE && later == MOST_LATER) {
                    ++lost;
                } else if (put != NONE) {
                    later_entry[later] = put;
                    later_t[later] = put_t;
                    ++later;
                }
            }
        }
        const uint number = entry & ENTRY_NUMBER;
        bool met = false;
        float t;
        vec3 normal;
        if (MESHES && (entry & ~ENTRY_NUMBER) == ENTRY_TRIANGLE) {
            ++visits;
            Site site;
            site.kind = KIND_MESH;
            site.point = vec3(0.0f);
            met = meet_facet(number, frame.origin, frame.direction, (least - frame.base) * per_unit,
                             (hit.t - frame.base) * per_unit, t, normal, site.uv) &&
                  !(PICTURES && scene.tables.y != 0u && is_clear(at - 1, frame.part, site));
            if (met) {
                // The frame is the mesh's own: the part that leads to it is the way's last.
                hit.t = frame.base + t * frame.unit;
                meeting.last = at - 1;
                meeting.part = frame.part;
                meeting.is_proxy = false;
                meeting.normal = normal;
                meeting.site = site;
                meeting.scale = kept(at - 1, direction).scale;
            }
            entry = NONE;
        } else if (entry != NONE) {
            ++visits;
            entry = NONE;
            const uint first = number * PART_SIZE;
            const vec4 row0 = parts(first), row1 = parts(first + 1u), row2 = parts(first + 2u),
                       facts = parts(first + 3u), ball = parts(first + 4u), node_facts = parts(first + 5u);
            const uint child = bits_of(facts).y, levels = bits_of(facts).w, node = child * NODE_SIZE;
            const float stretch = facts.x;
            const uvec4 marks = bits_of(node_facts);
            const uint kind = marks.y & NODE_KIND;
            const bool is_shape = (marks.y & NODE_PRIMITIVE) != 0u && kind != KIND_MESH;
            const float to_entry = max((entry_t - frame.base) * per_unit, 0.0f);
            const vec3 from = frame.origin + to_entry * frame.direction - vec3(row0.w, row1.w, row2.w);
            Frame inner;
            inner.origin = vec3(dot(xyz_of(row0), from), dot(xyz_of(row1), from), dot(xyz_of(row2), from));
            inner.low = vec3(0.0f);
            if (PAIRED) place_by_pairs(number, frame, to_entry, inner);
            // As long as before in a similarity, longer in others.
            inner.direction = frame.direction;
            if (!EVEN || is_shape)
                inner.direction = stretch * vec3(dot(xyz_of(row0), frame.direction), dot(xyz_of(row1), frame.direction),
                                                 dot(xyz_of(row2), frame.direction));
            inner.unit = frame.unit * stretch;
            inner.base = frame.base + to_entry * frame.unit;
            inner.scale = frame.scale * stretch;
            inner.part = number;
            inner.waiting = later;
            inner.steps = frame.steps == NONE ? NONE : frame.steps - levels;
            inner.cut = false;
            inner.faint = frame.faint;
            inner.margin = 0.0f;
            const float inner_per_unit = 1.0f / inner.unit;
            // The surface to meet, if there is one: a primitive, or the ball that stands for what is cut.
            bool meets = is_shape, is_proxy = false, widened = false;
            vec3 o = inner.origin, d = inner.direction;
            uint surface = kind;
            mat3 squeezed = mat3(1.0f);
            if (is_shape) {
                widened = FAINTS && frame.faint && kind != KIND_PLANE;
                if (widened) {
                    // About its middle, in the frame that it is drawn in.
                    const vec4 whole = parts(frame.part * PART_SIZE + 4u);
                    const vec3 place = place_of(xyz_of(whole), frame, at, origin, direction);
                    const float width = least_half_width(place, frame.scale * whole.w);
                    squeezed = squeezing(to_world(at, frame.scale, xyz_of(row0), xyz_of(row1), xyz_of(row2)),
                                         width / nodes(node + NODE_LOOK).w);
                    const vec3 centre = xyz_of(ball);
                    o = centre + squeezed * (o - centre);
                    d = squeezed * d;
                }
            } else if (at + 1 < MOST_FRAMES) {
                if (STRETCHED)
                    inner.scale =
                        place_space(at, frame.scale, xyz_of(row0), xyz_of(row1), xyz_of(row2), stretch);
                const float radius = inner.scale * ball.w;
                const vec3 place = place_of(xyz_of(ball), inner, at + 1, origin, direction);
                const float detail = 2.0f * radius * detail_per_unit(place, radius);
                const bool small = hurries || detail <= node_facts.x;
                inner.cut = ((marks.y & NODE_UNENDING) != 0u && inner.steps == 0u) || (node_facts.x > 0.0f && small);
                uint tree = inner.cut ? marks.w : marks.z;
                if (!inner.cut && !hurries) {
                    const uvec4 cells = bits_of(nodes(node + NODE_CELLS));
                    for (uint i = cells.x; i < cells.x + cells.y; ++i) {
                        const vec4 cell = nodes(i);
                        if (inner.steps >= bits_of(cell).w &&
                            inner.scale * cell.x * least_detail_per_unit(place, inner.scale * cell.y) > 1.0f) {
                            tree = bits_of(cell).z;
                            break;
                        }
                    }
                }
                if (inner.cut && tree != NONE && (marks.y & NODE_FAINT) != 0u && !inner.faint)
                    inner.faint = detail <= 1.0f;
                if (FAINTS && (marks.y & NODE_WIDENS) != 0u)
                    inner.margin = scene.widths.y * least_half_width(place, -2.0f * radius) / inner.scale *
                                   (STRETCHED ? most_extent(spaces[at + 1]) : 1.0f);
                if (tree != NONE) {
                    entry = tree;
                    entry_t = inner.base;
                    is_new = true;
                    ++at;
                    keep(at, inner);
                    frame = inner;
                } else if (inner.cut) {
                    meets = true;
                    is_proxy = true;
                    surface = KIND_SPHERE;
                    const vec4 proxy0 = nodes(node + NODE_PROXY), proxy1 = nodes(node + NODE_PROXY + 1u),
                               proxy2 = nodes(node + NODE_PROXY + 2u);
                    o = vec3(dot(xyz_of(proxy0), inner.origin) + proxy0.w, dot(xyz_of(proxy1), inner.origin) + proxy1.w,
                             dot(xyz_of(proxy2), inner.origin) + proxy2.w);
                    d = vec3(dot(xyz_of(proxy0), inner.direction), dot(xyz_of(proxy1), inner.direction),
                             dot(xyz_of(proxy2), inner.direction));
                    widened = FAINTS && (inner.faint || (marks.y & NODE_FAINT) != 0u);
                    if (widened) {
                        squeezed = squeezing(to_world(at + 1, inner.scale, xyz_of(proxy0), xyz_of(proxy1), xyz_of(proxy2)),
                                             least_half_width(place, radius));
                        o = squeezed * o;
                        d = squeezed * d;
                    }
                }
            } else {
                ++lost;
            }
            if (meets) {
                const int most_crossings = PICTURES ? 4 : 1;
                float begin = (least - inner.base) * inner_per_unit;
                const float end = (hit.t - inner.base) * inner_per_unit;
                Site site;
                site.kind = surface;
                site.uv = vec2(0.0f);
                for (int crossing = 0; crossing < most_crossings; ++crossing) {
                    met = meet_primitive(surface, nodes(node + NODE_LOOK).z, o, d, begin, end, t, normal);
                    site.point = (is_proxy ? inner.origin : o) + t * (is_proxy ? inner.direction : d);
                    if (!PICTURES || !met || is_proxy || scene.tables.y == 0u || !is_clear(at, number, site)) break;
                    begin = t;
                    met = false;
                }
                if (met) {
                    hit.t = inner.base + t * inner.unit;
                    if (widened) normal = squeezed * normal;
                    if (is_proxy)
                        normal = rows_transposed(nodes(node + NODE_PROXY), nodes(node + NODE_PROXY + 1u),
                                                 nodes(node + NODE_PROXY + 2u), normal);
                    meeting.last = is_proxy ? at + 1 : at;
                    meeting.part = number;
                    meeting.is_proxy = is_proxy;
                    meeting.normal = normal;
                    meeting.site = site;
                    meeting.scale = frame.scale;
                    if (is_proxy) met_marks[at + 1] = number | FRAME_CUT;
                }
            }
        }
        if (met) {
            found = true;
            if (any) break;
            keep_way(meeting.is_proxy ? meeting.last - 1 : meeting.last);
            // A pattern's is the scale of frames that the walk may leave.
            if (PATTERNS) hit.pattern_size = meeting.is_proxy ? 0.0f : pattern_size_of(meeting);
        }
        if (visits > scene.visits.x) {
            // What is left is drawn as coarsely as may be, then not at all.
            if (hurries || found) break;
            hurries = true;
            visits -= scene.visits.y;
        }
        if (entry == NONE) {
            while (entry == NONE && later > 0) {
                --later;
                if (later_t[later] < hit.t) {
                    entry = later_entry[later];
                    entry_t = later_t[later];
                }
            }
            if (entry == NONE) break;
            if (later < frame.waiting) {
                do
                    --at;
                while (later < int(frame_marks[at].w));
                frame = kept(at, direction);
                is_new = true;
            }
        }
        if (is_new) {
            per_unit = 1.0f / frame.unit;
            if (!EVEN) reciprocal = 1.0f / never_zero(frame.direction);
            shift = -frame.origin * reciprocal;
        }
    }
    steps += visits;
    if (found && !any) take_hit(meeting, hit);
    return found;
}
