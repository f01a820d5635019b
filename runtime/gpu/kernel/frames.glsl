// Places on the way of a ray, each in the frame of a part: kept while the ray is within it. MOST_FRAMES lie on the way
// from the root.

/// A place on the way, and the ray there: origin + (t - base) / unit * direction.
struct Frame {
    vec3 origin;
    vec3 low;     // what the origin has lost by rounding, where PAIRED
    float base;
    vec3 direction;
    float unit;
    float scale;  // norm of the map to the world; the unit, unless STRETCHED
    vec3 margin;  // by which parts may reach out of their boxes along each axis, where FAINTS
    uint steps;   // levels that are left
    uint part;    // the last on the way
    int waiting;  // entries that waited when the ray came here
    bool cut;     // drawn by what stands for its parts
    bool faint;   // what is drawn stands for a set without area
};

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
    if (STRETCHED || FAINTS) frame_scales[at] = frame.scale;
    if (FAINTS) frame_margins[at] = frame.margin;
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
    if (STRETCHED || FAINTS) frame.scale = frame_scales[at];
    frame.margin = vec3(0.0f);
    if (FAINTS) frame.margin = frame_margins[at];
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

/// Where the frame of a part begins, in the frame that holds it.
vec3 origin_of(uint part) {
    const uint first = part * PART_SIZE;
    return vec3(parts(first).w, parts(first + 1u).w, parts(first + 2u).w);
}

/// Half of what is drawn at least of a set without area, about a point of the world: Projection's
/// least_half_width(), or most_half_width() with a negative radius.
float least_half_width(vec3 from_eye, float radius) {
    if (scene.projection.w == 0.0f) return 0.0f;
    if (scene.projection.z > 0.0f) return scene.projection.z;
    if (scene.direction.w > 0.0f) return scene.widths.x / scene.projection.x;
    const float distance = max(dot(from_eye, xyz_of(scene.direction)), 0.5f * length(from_eye));
    return scene.widths.x * max(distance - radius, scene.projection.y) / scene.projection.x;
}

/// The detail of a length of 1 about a point of the world, which is seen where no edge of the view is farther than
/// `beside` and it lies at least `before` in front of the eye. `nearer`: by which it may be nearer than the point.
float detail_about(vec3 from_eye, float beside, float before, float nearer) {
    if (scene.projection.w == 0.0f) return FAR;
    const float aside = abs(dot(from_eye, xyz_of(scene.right))), above = abs(dot(from_eye, xyz_of(scene.up)));
    const bool parallel = scene.direction.w > 0.0f;
    const float along = dot(from_eye, xyz_of(scene.direction)), depth = parallel ? 1.0f : along;
    const bool seen = aside * scene.edges.y - depth * scene.edges.x <= beside &&
                      above * scene.edges.w - depth * scene.edges.z <= beside && (parallel || along >= before);
    const float coarser = seen ? 1.0f : 8.0f;
    if (scene.projection.z > 0.0f) return 1.0f / (scene.projection.z * coarser);
    if (parallel) return scene.projection.x / coarser;
    const float distance = max(along, 0.5f * length(from_eye));
    return scene.projection.x / (max(distance - nearer, scene.projection.y) * coarser);
}

/// Projection::detail_per_unit().
float detail_per_unit(vec3 from_eye, float radius) {
    return detail_about(from_eye, radius, -radius, radius);
}

/// At most the detail of a length of 1 anywhere so far about that point.
float least_detail_per_unit(vec3 from_eye, float reach) {
    return detail_about(from_eye, -2.0f * reach, reach, -reach);
}

vec3 rows_transposed(vec4 a, vec4 b, vec4 c, vec3 v) {
    return v.x * xyz_of(a) + v.y * xyz_of(b) + v.z * xyz_of(c);
}

/// A normal of a part in the frame that holds it.
vec3 normal_above(uint part, vec3 normal) {
    const uint first = part * PART_SIZE;
    const vec3 n = rows_transposed(parts(first), parts(first + 1u), parts(first + 2u), normal);
    const float length2 = dot(n, n);
    return length2 > 0.0f ? n * inversesqrt(length2) : normal;
}

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

/// The linear part of parent_from_child of a part.
mat3 inverse_of_part(uint part) {
    const uint first = part * PART_SIZE;
    if (CRUSHES && (bits_of(parts(first + 3u)).w & PART_OUTWARDS) != 0u)
        return transpose(mat3(xyz_of(parts(first)), xyz_of(parts(first + 1u)), xyz_of(parts(first + 2u))));
    return inverse_of(xyz_of(parts(first)), xyz_of(parts(first + 1u)), xyz_of(parts(first + 2u)));
}

/// The linear map to the world from within a part, by the rows of that into it. `at`: of the frame that holds it, of
/// this scale.
mat3 to_world(int at, float scale, vec3 row0, vec3 row1, vec3 row2) {
    const mat3 part = scale * inverse_of(row0, row1, row2);
    return STRETCHED ? spaces[at] * part : part;
}

/// The inverse of a map once its singular values below `low` are raised to `least`. Jacobi's turns make its columns
/// orthogonal: those of what is crushed keep their digits, and what has none left is replaced.
mat3 raised_inverse(mat3 map, float low, float least) {
    mat3 image = map / least, axes = mat3(1.0f);
    for (int turn = 0; turn < 12; ++turn) {
        const int p = turn % 3, q = (p + 1) % 3;
        const vec3 a = image[p], b = image[q], axis = axes[p];
        const float aa = dot(a, a), bb = dot(b, b), ab = dot(a, b);
        if (!(abs(ab) > 1e-7f * sqrt(aa * bb))) continue;
        const float ratio = 0.5f * (bb - aa) / ab;
        const float tangent = (ratio < 0.0f ? -1.0f : 1.0f) / (abs(ratio) + sqrt(ratio * ratio + 1.0f));
        const float cosine = inversesqrt(tangent * tangent + 1.0f), sine = tangent * cosine;
        image[p] = cosine * a - sine * b;
        image[q] = sine * a + cosine * b;
        axes[p] = cosine * axis - sine * axes[q];
        axes[q] = sine * axis + cosine * axes[q];
    }
    if (CRUSHES) {
        // The longest first.
        for (int i = 0; i < 3; ++i) {
            const int p = i % 2, q = p + 1;
            const vec3 shorter = image[p], axis = axes[p];
            if (!(dot(shorter, shorter) < dot(image[q], image[q]))) continue;
            image[p] = image[q];
            image[q] = shorter;
            axes[p] = axes[q];
            axes[q] = axis;
        }
    }
    const vec3 sizes = vec3(length(image[0]), length(image[1]), length(image[2]));
    const vec3 a = image[0] / sizes.x;
    vec3 b = image[1] / sizes.y, c = image[2] / sizes.z;
    if (CRUSHES) {
        const float lost = CRUSHED * sizes.x;
        if (!(sizes.y > lost)) b = normalize(cross(a, abs(a.x) < 0.6f ? vec3(1.0f, 0.0f, 0.0f) : vec3(0.0f, 1.0f, 0.0f)));
        // The map is to mirror nothing then.
        if (!(sizes.z > lost)) c = dot(axes[0], cross(axes[1], axes[2])) < 0.0f ? cross(b, a) : cross(a, b);
    }
    const float lowest = low / least;
    return (outerProduct(axes[0], a) / (sizes.x > lowest ? sizes.x : 1.0f) +
            outerProduct(axes[1], b) / (sizes.y > lowest ? sizes.y : 1.0f) +
            outerProduct(axes[2], c) / (sizes.z > lowest ? sizes.z : 1.0f)) /
           least;
}

/// Half axes of the image of a ball that are shorter than the width become as long: the map by which rays meet
/// that, in the ball's own space (least_width.h).
mat3 squeezing(mat3 world_from_ball, float width) {
    return raised_inverse(world_from_ball, width, width) * world_from_ball;
}

/// Half of the extents along the axes of a frame that a ball of the world has there, which has 1.
vec3 extents_of_ball(mat3 space) {
    const vec3 bc = cross(space[1], space[2]), ca = cross(space[2], space[0]), ab = cross(space[0], space[1]);
    return vec3(length(bc), length(ca), length(ab)) / abs(dot(space[0], bc));
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

/// What the world makes of a part. The ball and the size tell of any, what follows of what is crushed there.
struct Crushing {
    vec4 ball;       // of the part, in the frame
    float size;      // norm of its map, likewise
    mat3 rows;       // of that map with some thickness
    vec3 moved;      // by which its points lie elsewhere then, so that its middle stays where it is
    float thickness; // in the frame
    bool is_wide;    // it is drawn wider than it is
    bool to_line;    // and is a line at most
};

/// Whether a part is crushed.
bool crush(uint part, Frame frame, int at, vec3 origin, vec3 direction, OUT(Crushing) crushing) {
    const mat3 parent_from_part = inverse_of_part(part), map = spaces[at] * parent_from_part;
    const vec3 ab = cross(map[0], map[1]), bc = cross(map[1], map[2]), ca = cross(map[2], map[0]);
    const float area = sqrt(max(max(dot(ab, ab), dot(bc, bc)), dot(ca, ca))), volume = abs(dot(map[0], bc));
    const vec4 ball = parts(part * PART_SIZE + 4u), node_facts = parts(part * PART_SIZE + 5u);
    const vec3 middle = parent_from_part * xyz_of(ball);
    const float size = largest_stretch(map);
    crushing.ball = vec4(middle + origin_of(part), size * ball.w);
    crushing.size = size;
    if (area > CRUSHED * size * size && volume > CRUSHED * area * size) return false;
    crushing.to_line = !(area > SINGULAR * size * size);
    crushing.is_wide = crushing.to_line || !(volume > SINGULAR * area * size);
    const vec3 place = place_of(xyz_of(crushing.ball), frame, at, origin, direction);
    const float half_width = least_half_width(place, frame.scale * crushing.ball.w) / frame.scale;
    const float thickness = half_width > 0.0f ? min(half_width, THICKEST_CRUSHED * size) : THICKNESS_UNCULLED * size;
    const bool is_mesh = (bits_of(node_facts).y & NODE_KIND) == KIND_MESH;
    crushing.thickness = FAINTS && !is_mesh ? THICKNESS_INSIDE * thickness
                                            : thickness / nodes(node_of(part) * NODE_SIZE + NODE_LOOK).w;
    crushing.rows = transpose(raised_inverse(map, CRUSHED * size, crushing.thickness) * spaces[at]);
    crushing.moved = xyz_of(ball) - middle * crushing.rows;
    return true;
}

/// A normal in the world from one in a frame of this space. Cofactors need no inverse of what is nearly crushed.
vec3 normal_in_world(mat3 space, vec3 normal) {
    const vec3 bc = cross(space[1], space[2]), ca = cross(space[2], space[0]), ab = cross(space[0], space[1]);
    const vec3 n = normal.x * bc + normal.y * ca + normal.z * ab;
    return normalize(dot(space[0], bc) < 0.0f ? -n : n);
}

/// Whether the ray passes a point of frame `at` farther away in the world than `reach`. Where parts are drawn wider than
/// they are, that says more than boxes, above all in what is crushed: a ball of the world is long in all directions there.
bool passes_beside(vec3 point, float reach, Frame frame, int at, vec3 direction) {
    const float along = dot(point - frame.origin, frame.direction) / dot(frame.direction, frame.direction);
    vec3 beside = frame.scale * (point - frame.origin - along * frame.direction);
    if (STRETCHED) {
        beside = spaces[at] * beside;
        beside -= dot(beside, direction) * direction;
    }
    return dot(beside, beside) > reach * reach;
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

/// The origin of a ray in a part of these rows, `along` from that of frame `outer`: errors of rounding would grow with
/// each level. `has_lows`: the rows are those of parts[].
void place_by_pairs(uint part, vec4 row0, vec4 row1, vec4 row2, bool has_lows, Frame outer, float along,
                    INOUT(Frame) inner) {
    vec3 at = outer.origin;
    vec3 at_low = outer.low;
    vec3 product;
    vec3 left;
    pair_of_product(vec3(along), outer.direction, product, left);
    add_pair(product, left, at, at_low);
    const vec4 low0 = lows(part * LOW_SIZE), low1 = lows(part * LOW_SIZE + 1u), low2 = lows(part * LOW_SIZE + 2u);
    add_pair(-vec3(row0.w, row1.w, row2.w), -vec3(low0.w, low1.w, low2.w), at, at_low);
    inner.origin = vec3(0.0f);
    inner.low = vec3(0.0f);
    for (int k = 0; k < 3; ++k) {
        const vec3 column = vec3(row0[k], row1[k], row2[k]),
                   column_low = has_lows ? vec3(low0[k], low1[k], low2[k]) : vec3(0.0f);
        pair_of_product(column, vec3(at[k]), product, left);
        PRECISE vec3 small = left + (column * at_low[k] + column_low * at[k]);
        add_pair(product, small, inner.origin, inner.low);
    }
}
