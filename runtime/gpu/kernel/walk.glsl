// Rays through the cyclic graph itself, depth first and the nearest first, into the frame of each part, as deep
// as the parts are that the view shows (Traversal of runtime/trace does the same in doubles).

// MOST_LATER entries wait. A ray that needs more room counts as lost.

/// Rays of the thread, boxes and parts that they went to, and parts that they had no room for.
STEPS

/// Distance up to which a hit is near enough, if none can be nearer by more than this share of the half width
/// (NearEnough::distance()).
float near_enough(vec3 origin, vec3 direction, float share) {
    const float slope = dot(xyz_of(scene.plane), direction);
    if (slope == 0.0f) return -FAR;
    const float middle = (scene.plane.w - dot(xyz_of(scene.plane), origin)) / slope;
    const vec3 here = origin + middle * direction;
    const float most = scene.plane_parts.x, half_width = min(most, least_half_width(here, -2.0f * most));
    const float height = max(scene.plane_parts.y * half_width, scene.plane_parts.z / detail_per_unit(here, 2.0f * most));
    return middle - height / abs(slope) + share * half_width;
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
    hit.faded = 0.0f;
    const float enough = FAINTS ? near_enough(origin, direction, NEAR_ENOUGH_SHARE) : -FAR,
                plenty = FAINTS ? near_enough(origin, direction, PLENTY_SHARE) : -FAR;
    float crushed_enough = -FAR; // likewise, in what is crushed and gone through
    int crushed_later = 0;       // entries that waited when the ray came to it
    int wide_from = MOST_FRAMES; // frames from here on are drawn wide as crushed
    Meeting meeting;
    Frame frame;
    frame.origin = origin;
    frame.low = vec3(0.0f);
    frame.base = 0.0f;
    frame.direction = direction;
    frame.unit = 1.0f;
    frame.scale = 1.0f;
    frame.margin = vec3(scene.widths.z);
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
            const vec3 margin = FAINTS ? frame.margin : vec3(0.0f);
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
                meeting.widened = false;
                meeting.crushed = crushed_enough > -FAR;
                if (CRUSHES && meeting.crushed) {
                    meeting.normal = normal_in_world(spaces[at], normal);
                    if (SHEETS)
                        meeting.to_far_side =
                            to_far_side(frame.scale * spaces[at], node_of(frame.part) * NODE_SIZE, false, true, direction);
                }
            }
            entry = NONE;
        } else if (entry != NONE) {
            ++visits;
            entry = NONE;
            const uint first = number * PART_SIZE;
            vec4 row0 = parts(first), row1 = parts(first + 1u), row2 = parts(first + 2u);
            const vec4 facts = parts(first + 3u), ball = parts(first + 4u), node_facts = parts(first + 5u);
            const uint child = bits_of(facts).y, levels = bits_of(facts).w & PART_LEVELS, node = child * NODE_SIZE;
            const bool was_crushed = CRUSHES && crushed_enough > -FAR;
            const float stretch = facts.x;
            const uvec4 marks = bits_of(node_facts);
            const uint kind = marks.y & NODE_KIND;
            const bool is_shape = (marks.y & NODE_PRIMITIVE) != 0u && kind != KIND_MESH;
            float to_entry = max((entry_t - frame.base) * per_unit, 0.0f);
            vec3 from = frame.origin + to_entry * frame.direction - vec3(row0.w, row1.w, row2.w);
            Crushing crushing;
            const bool crushes = CRUSHES && at > 0 && crush(number, frame, at, origin, direction, crushing);
            if (crushes) {
                const mat3 rows = crushing.rows;
                row0 = vec4(rows[0], row0.w);
                row1 = vec4(rows[1], row1.w);
                row2 = vec4(rows[2], row2.w);
                // Nearest to the middle of what is crushed, its numbers are small.
                const vec3 way = frame.direction * rows;
                to_entry -= dot(from * rows, way) / dot(way, way);
                from = frame.origin + to_entry * frame.direction - vec3(row0.w, row1.w, row2.w);
            }
            const bool is_crushed = was_crushed || crushes;
            const bool is_wide = CRUSHES && (at >= wide_from || (crushes && crushing.is_wide));
            Frame inner;
            inner.origin = vec3(dot(xyz_of(row0), from), dot(xyz_of(row1), from), dot(xyz_of(row2), from));
            inner.low = vec3(0.0f);
            if (PAIRED) place_by_pairs(number, row0, row1, row2, !crushes, frame, to_entry, inner);
            // As long as before in a similarity, longer in others.
            inner.direction = frame.direction;
            if (!EVEN || is_shape)
                inner.direction = stretch * vec3(dot(xyz_of(row0), frame.direction), dot(xyz_of(row1), frame.direction),
                                                 dot(xyz_of(row2), frame.direction));
            inner.unit = frame.unit * stretch;
            float slope = 0.0f; // the sine of the angle at which the ray meets what is crushed
            if (crushes) {
                inner.origin += crushing.moved;
                const float growth = length(inner.direction);
                inner.direction /= growth;
                inner.unit = max(inner.unit / growth, 1e-30f);
                slope = growth / stretch * crushing.thickness / length(frame.direction);
            }
            inner.base = frame.base + to_entry * frame.unit;
            inner.scale = frame.scale * stretch;
            inner.part = number;
            inner.waiting = later;
            inner.steps = frame.steps == NONE ? NONE : frame.steps - levels;
            inner.cut = false;
            inner.faint = frame.faint || (crushes && crushing.to_line);
            inner.margin = vec3(0.0f);
            const float inner_per_unit = 1.0f / inner.unit;
            // The surface to meet, if there is one: a primitive, or the ball that stands for what is cut.
            bool meets = is_shape, is_proxy = false, widened = false;
            vec3 o = inner.origin, d = inner.direction;
            uint surface = kind;
            mat3 squeezed = mat3(1.0f);
            if (is_shape) {
                widened = FAINTS && (inner.faint || is_wide) && kind != KIND_PLANE;
                if (widened) {
                    // About the middle of the frame that it is drawn in, or of what is crushed.
                    vec4 whole = parts(frame.part * PART_SIZE + 4u);
                    float thickest = FAR;
                    if (CRUSHES && !inner.faint) {
                        whole = crushing.ball;
                        thickest = THICKEST_CRUSHED * frame.scale * crushing.size;
                    }
                    const vec3 place = place_of(xyz_of(whole), frame, at, origin, direction);
                    const float width = min(least_half_width(place, frame.scale * whole.w), thickest);
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
                const float widest = FAINTS ? scene.widths.y * least_half_width(place, -2.0f * radius) : 0.0f;
                const bool is_beside =
                    FAINTS && (marks.y & NODE_PRIMITIVE) == 0u &&
                    passes_beside(xyz_of(ball), inner.scale * nodes(node + NODE_LOOK).y + widest, inner, at + 1, direction);
                if (!inner.cut && !hurries && !was_crushed) {
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
                if (FAINTS && ((marks.y & NODE_WIDENS) != 0u || is_wide))
                    inner.margin =
                        widest / inner.scale * (STRETCHED ? extents_of_ball(spaces[at + 1]) : vec3(1.0f));
                if (tree != NONE && !is_beside) {
                    entry = tree;
                    entry_t = inner.base;
                    is_new = true;
                    if (is_wide) wide_from = min(wide_from, at + 1);
                    if (crushes && !was_crushed) {
                        // Thousands of parts may lie there, all of them as wide.
                        crushed_enough = inner.base - (1.0f - NEAR_ENOUGH_SHARE) * least_half_width(place, 0.0f) /
                                                          max(slope, 1e-6f);
                        crushed_later = later;
                    }
                    ++at;
                    keep(at, inner);
                    frame = inner;
                } else if (inner.cut && !is_beside) {
                    meets = true;
                    is_proxy = true;
                    surface = KIND_SPHERE;
                    const vec4 proxy0 = nodes(node + NODE_PROXY), proxy1 = nodes(node + NODE_PROXY + 1u),
                               proxy2 = nodes(node + NODE_PROXY + 2u);
                    o = vec3(dot(xyz_of(proxy0), inner.origin) + proxy0.w, dot(xyz_of(proxy1), inner.origin) + proxy1.w,
                             dot(xyz_of(proxy2), inner.origin) + proxy2.w);
                    d = vec3(dot(xyz_of(proxy0), inner.direction), dot(xyz_of(proxy1), inner.direction),
                             dot(xyz_of(proxy2), inner.direction));
                    const bool is_faint = inner.faint || (marks.y & NODE_FAINT) != 0u;
                    widened = FAINTS && (is_faint || is_wide);
                    if (widened) {
                        const float width = least_half_width(place, radius);
                        squeezed = squeezing(to_world(at + 1, inner.scale, xyz_of(proxy0), xyz_of(proxy1), xyz_of(proxy2)),
                                             is_faint ? width : min(width, THICKEST_CRUSHED * radius));
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
                    if (widened) normal = normal * squeezed;
                    if (is_proxy)
                        normal = rows_transposed(nodes(node + NODE_PROXY), nodes(node + NODE_PROXY + 1u),
                                                 nodes(node + NODE_PROXY + 2u), normal);
                    meeting.last = is_proxy ? at + 1 : at;
                    meeting.part = number;
                    meeting.is_proxy = is_proxy;
                    meeting.crushed = is_crushed;
                    if (CRUSHES && meeting.crushed) {
                        normal = is_proxy ? normal_in_world(spaces[at + 1], normal)
                                          : normal_in_world(spaces[at], rows_transposed(row0, row1, row2, normal));
                        if (SHEETS) {
                            mat3 leaf = is_proxy ? inner.scale * spaces[at + 1] * map_from_proxy(node)
                                                 : to_world(at, frame.scale, xyz_of(row0), xyz_of(row1), xyz_of(row2));
                            if (widened) leaf = leaf * inverse(squeezed);
                            meeting.to_far_side = to_far_side(leaf, node, is_proxy, true, direction);
                        }
                    }
                    meeting.normal = normal;
                    meeting.site = site;
                    meeting.scale = frame.scale;
                    meeting.widened = widened;
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
        if (CRUSHES && found && hit.t <= crushed_enough && visits > PATIENCE) {
            entry = NONE;
            later = crushed_later;
        }
        if (FAINTS && found && (hit.t <= plenty || (hit.t <= enough && visits > PATIENCE))) break;
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
                if (later < crushed_later) crushed_enough = -FAR;
                if (at < wide_from) wide_from = MOST_FRAMES;
            }
        }
        if (is_new) {
            per_unit = 1.0f / frame.unit;
            if (!EVEN) reciprocal = 1.0f / never_zero(frame.direction);
            shift = -frame.origin * reciprocal;
        }
    }
    steps += visits;
    if (found && !any) take_hit(meeting, origin, direction, hit);
    return found;
}
