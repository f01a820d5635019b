#include "runtime/trace/traversal.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "compiler/cut/bake.h"
#include "runtime/trace/surface_normal.h"

namespace graftal {

namespace {

/// Nodes and primitives that one ray may go into. Sound models need some tens or hundreds; where thousands of
/// parts coincide, a ray would not come to an end.
constexpr std::uint64_t most_visits = 1 << 17;
/// Parts smaller than this are nothing: their inverse maps would not be numbers.
constexpr double least_scale = 1e-150;
/// Allows for the rounding of what is a little more than enough.
constexpr double surely_more = 1 - 1e-6;

/// One bit for each lane that is true.
template<Instructions instructions> GRAFTAL_INLINE std::uint32_t bits_of(const Int8& lanes) {
#if defined(__x86_64__) && !defined(__clang__)
    if constexpr (instructions == Instructions::avx2) {
        std::uint32_t bits;
        // An intrinsic could not be inlined from here: only the caller is compiled for AVX2. Clang looks at
        // the operands before it inlines.
        __asm__("vmovmskps %1, %0" : "=r"(bits) : "x"(lanes));
        return bits;
    }
#endif
    std::uint32_t bits = 0;
    for (int lane = 0; lane < 8; ++lane)
        bits |= static_cast<std::uint32_t>(lanes[lane] & 1) << lane;
    return bits;
}

/// The range of t in which a ray is within a box; empty where least > most.
RayRange range_in(const Box& box, const Ray& ray, RayRange range) {
    for (int axis = 0; axis < 3; ++axis) {
        const double d = ray.direction[axis];
        if (d == 0) {
            if (ray.origin[axis] < box.min[axis] || ray.origin[axis] > box.max[axis]) return {1, 0};
            continue;
        }
        const double a = (box.min[axis] - ray.origin[axis]) / d;
        const double b = (box.max[axis] - ray.origin[axis]) / d;
        range.least = std::max(range.least, std::min(a, b));
        range.most = std::min(range.most, std::max(a, b));
    }
    return range;
}

/// norm(), to about 1e-8, and an order of magnitude faster: the root of the largest eigenvalue of A^T A, which
/// solves a cubic (O. Smith, "Eigenvalues of a symmetric 3x3 matrix", 1961).
double largest_stretch(const LaneMap& map) {
    const Vec3 a = vec3_of(map.column[0]), b = vec3_of(map.column[1]), c = vec3_of(map.column[2]);
    const double aa = glm::dot(a, a), bb = glm::dot(b, b), cc = glm::dot(c, c);
    const double mean = (aa + bb + cc) / 3;
    if (!(mean > 1e-250)) return norm(map.affine().linear);
    // Of the matrix less its mean eigenvalue, in units of that.
    const double x = aa / mean - 1, y = bb / mean - 1, z = cc / mean - 1;
    const double xy = glm::dot(a, b) / mean, yz = glm::dot(b, c) / mean, zx = glm::dot(c, a) / mean;
    const double p2 = (x * x + y * y + z * z + 2 * (xy * xy + yz * yz + zx * zx)) / 6;
    if (!(p2 > 0)) return std::sqrt(mean);
    const double p = std::sqrt(p2);
    const double determinant =
        x * (y * z - yz * yz) - xy * (xy * z - yz * zx) + zx * (xy * yz - y * zx);
    const double angle = std::acos(std::clamp(0.5 * determinant / (p2 * p), -1.0, 1.0)) / 3;
    return std::sqrt(mean * (1 + 2 * p * std::cos(angle)));
}

bool has_flat_part(const TraceModel& model, const TraceNode& node, const LaneMap& world_from_node, bool cut) {
    const std::uint32_t first = node.first_edge + (cut ? node.edge_count : 0);
    const std::uint32_t count = cut ? node.stop_edge_count : node.edge_count;
    const Affine place = world_from_node.affine();
    for (std::uint32_t i = first; i < first + count; ++i) {
        const TraceEdge& edge = model.edges[i];
        if (!edge.similarity && is_singular(place * edge.parent_from_child.affine(), flattest_placement))
            return true;
    }
    return false;
}

/// The box, larger by what rounding and thickened parts may need.
Box enlarged(const Box& box, double margin) {
    const Vec3 more = 1e-9 * box.size() + Vec3(margin);
    return {box.min - more, box.max + more};
}

} // namespace

template<Instructions instructions> struct Traversal::Kernel {
    Traversal& self;
    const TraceModel& model;
    const RayRange range;
    bool any;

    GRAFTAL_INLINE bool run(const Ray& ray) {
        self.depth_ = 0;
        self.entry_count_ = 0;
        self.best_.found = false;
        self.best_.t = range.most;
        const std::uint64_t limit = self.visits_ + most_visits;
        push_world(ray);
        try_edge(self.frames_.front(), 0);
        while (self.entry_count_ > 0) {
            const Entry entry = self.entries_[--self.entry_count_];
            if (!(entry.t < self.best_.t)) continue;
            self.depth_ = entry.frame + 1;
            if (entry.entry & BoxNode::inner)
                test_boxes(model.boxes, entry.entry & ~BoxNode::inner, entry.frame);
            else
                enter(entry);
            if (any && self.best_.found) return true;
            if (self.visits_ > limit) {
                ++self.given_up_;
                break;
            }
        }
        return self.best_.found;
    }

    GRAFTAL_INLINE Frame& push() {
        if (self.depth_ == self.frames_.size()) self.frames_.emplace_back();
        return self.frames_[self.depth_++];
    }

    GRAFTAL_INLINE void push_world(const Ray& ray) {
        Frame& frame = push();
        frame.world_from_node = LaneMap();
        frame.origin = lanes_of(ray.origin);
        frame.direction = lanes_of(ray.direction);
        frame.largest = largest_component(frame.direction);
        frame.unit = 1 / frame.largest;
        frame.base = 0;
        frame.scale = 1;
        frame.edge = no_edge;
        frame.steps = model.prepared.root_steps;
        frame.cut = false;
        frame.flatness = 1;
        frame.margin = 0;
    }

    /// Where boxes are few or infinite: in double precision.
    GRAFTAL_INLINE void try_edge(const Frame& frame, std::uint32_t number) {
        const TraceEdge& edge = model.edges[number];
        const TraceNode& child = model.nodes[edge.child];
        double t = range.least;
        const bool endless = child.kind == TraceNode::Kind::unbounded || child_is_plane(child);
        if (!endless) {
            const RayRange within{range.least - frame.base, self.best_.t - frame.base};
            const Ray ray{vec3_of(frame.origin), vec3_of(frame.direction)};
            const RayRange inside = range_in(enlarged(edge.box, frame.margin), ray, within);
            if (!(inside.least <= inside.most)) return;
            t = frame.base + inside.least;
        }
        reserve_entries(1);
        self.entries_[self.entry_count_++] = {t, number, static_cast<std::uint32_t>(self.depth_ - 1)};
    }

    GRAFTAL_INLINE static bool child_is_plane(const TraceNode& node) {
        return node.kind == TraceNode::Kind::primitive && node.primitive == PrimitiveKind::plane;
    }

    /// Sorts the boxes that the ray meets, the nearest last.
    GRAFTAL_INLINE void test_boxes(const std::vector<BoxNode>& boxes, std::uint32_t number,
                                   std::uint32_t frame_number) {
        const BoxNode& node = boxes[number];
        const Frame& frame = self.frames_[frame_number];
        const float least = static_cast<float>((range.least - frame.base) * frame.largest);
        // A little more, for what single precision leaves out.
        const float most = static_cast<float>((self.best_.t - frame.base) * frame.largest) + 2e-6f;
        Float8 enters = splat8(least), leaves = splat8(most);
        for (int axis = 0; axis < 3; ++axis) {
            const Float8 reciprocal = splat8(frame.reciprocal[axis]);
            const Float8 a = (node.lower[axis] - splat8(frame.lower_origin[axis])) * reciprocal;
            const Float8 b = (node.upper[axis] - splat8(frame.upper_origin[axis])) * reciprocal;
            enters = greater(enters, lesser(a, b));
            leaves = lesser(leaves, greater(a, b));
        }
        reserve_entries(8);
        Entry* const first = self.entries_.data() + self.entry_count_;
        Entry* end = first;
        for (std::uint32_t lanes = bits_of<instructions>(enters <= leaves); lanes != 0; lanes &= lanes - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
            const Entry entry{frame.base + static_cast<double>(enters[lane]) * frame.unit, node.entry[lane],
                              frame_number};
            Entry* place = end++;
            for (; place > first && place[-1].t < entry.t; --place)
                *place = place[-1];
            *place = entry;
        }
        self.entry_count_ += static_cast<std::size_t>(end - first);
    }

    GRAFTAL_INLINE void reserve_entries(std::size_t count) {
        if (self.entry_count_ + count > self.entries_.size()) self.entries_.resize(2 * self.entries_.size());
    }

    GRAFTAL_INLINE void enter(const Entry& entry) {
        ++self.visits_;
        const TraceEdge& edge = model.edges[entry.entry];
        const TraceNode& node = model.nodes[edge.child];
        const Frame& parent = self.frames_[entry.frame];
        const Double4 near = parent.origin + splat(entry.t - parent.base) * parent.direction;
        const Double4 origin = point_through(edge.child_from_parent, near);
        const Double4 direction = direction_through(edge.child_from_parent, parent.direction);
        double largest;
        if (edge.similarity) {
            // The direction grows as much as the map shrinks; to compute its length anew would take longer.
            largest = parent.largest * edge.growth;
        } else {
            largest = largest_component(direction);
            if (!(largest > 0 && largest < 1 / least_scale)) return;
        }
        if (node.kind == TraceNode::Kind::primitive)
            return meet(node.primitive, parent, entry, LaneMap(), false, origin, direction, largest);

        const double parent_unit = parent.unit;
        Frame& frame = push();
        const Frame& above = self.frames_[entry.frame]; // may have moved
        compose(above.world_from_node, edge.parent_from_child, frame.world_from_node);
        frame.edge = entry.entry | (above.cut ? from_cut : 0);
        frame.node = edge.child;
        frame.steps = above.steps == unlimited_steps ? above.steps : above.steps - edge.levels;
        frame.scale =
            edge.similarity ? above.scale * edge.stretch : largest_stretch(frame.world_from_node);
        if (!(frame.scale > least_scale)) return;
        frame.flatness = above.flatness * (edge.similarity ? 1 : edge.flatness);
        frame.cut = is_cut(node, frame);
        if (frame.cut && node.stop_tree == no_tree) {
            const Double4 o = point_through(node.proxy_from_node, origin);
            const Double4 d = direction_through(node.proxy_from_node, direction);
            return meet(PrimitiveKind::sphere, frame, entry, node.node_from_proxy, true, o, d,
                        largest_component(d));
        }
        frame.origin = origin;
        frame.direction = direction;
        frame.base = entry.t;
        frame.largest = largest;
        frame.unit = edge.similarity ? parent_unit * edge.stretch : 1 / largest;
        const auto number = static_cast<std::uint32_t>(self.depth_ - 1);
        if (node.kind == TraceNode::Kind::unbounded) {
            frame.margin = 0;
            for (std::uint32_t i = 0; i < node.edge_count; ++i)
                try_edge(frame, node.first_edge + i);
            return;
        }
        const bool baked = node.kind == TraceNode::Kind::mesh || too_flat(node, frame);
        frame.margin = baked ? thickness(node, frame) : 0;
        const Float4 d = __builtin_convertvector(direction * splat(frame.unit), Float4);
        // Where it is 0 something small: far beyond all boxes, but a number, and 0 times it is 0.
        constexpr Float4 least = {1e-18f, 1e-18f, 1e-18f, 1e-18f};
        const Float4 magnitude = d < 0 ? -d : d;
        frame.reciprocal = 1 / (magnitude > least ? d : least);
        const Float4 o = __builtin_convertvector(origin, Float4);
        frame.lower_origin = o + frame.margin;
        frame.upper_origin = o - frame.margin;
        if (baked) return meet_mesh(self.mesh_of(frame), number);
        if (frame.cut && node.stop_edge_count == 1) { // about as large as the node: no box to test
            reserve_entries(1);
            self.entries_[self.entry_count_++] = {entry.t, node.first_edge + node.edge_count, number};
            return;
        }
        const std::uint32_t tree = frame.cut ? node.stop_tree : tree_of(node, frame);
        if (tree != no_tree) test_boxes(model.boxes, tree, number);
    }

    GRAFTAL_INLINE Ball world_ball(const TraceNode& node, const Frame& frame) const {
        return {vec3_of(point_through(frame.world_from_node, node.ball_centre)),
                frame.scale * node.ball_radius};
    }

    /// The parts that are farthest down, of those that are drawn for sure if none is cut.
    GRAFTAL_INLINE std::uint32_t tree_of(const TraceNode& node, const Frame& frame) const {
        if (node.unrolling_count == 0) return node.tree;
        double detail = model.least_detail_per_unit;
        bool known = false;
        for (std::uint32_t i = 0; i < node.unrolling_count; ++i) {
            const Unrolling& unrolling = model.unrollings[node.first_unrolling + i];
            if (frame.steps < unrolling.least_steps) continue;
            if (!(frame.flatness * unrolling.flattest_edge > flattest_placement)) continue;
            const double size = surely_more * frame.scale * unrolling.least_size;
            if (size * detail > 1) return unrolling.tree;
            if (known) continue;
            detail = model.projection.least_detail_per_unit(
                {vec3_of(point_through(frame.world_from_node, node.ball_centre)), frame.scale * node.reach});
            known = true;
            if (size * detail > 1) return unrolling.tree;
        }
        return node.tree;
    }

    /// Whether some part could not be placed by itself, it is so flat: the cut bakes the node then
    /// (assemble.cpp).
    GRAFTAL_INLINE bool too_flat(const TraceNode& node, const Frame& frame) const {
        if (frame.flatness * node.flattest_edge > flattest_placement) return false;
        return has_flat_part(model, node, frame.world_from_node, frame.cut);
    }

    /// What parts may be thickened by, in the frame (bake.h, leaf_thickness).
    GRAFTAL_INLINE float thickness(const TraceNode& node, const Frame& frame) const {
        const double detail = frame.scale * model.projection.detail_per_unit(world_ball(node, frame));
        return std::isfinite(detail) ? static_cast<float>(1.5 / detail) : 2e-3f;
    }

    GRAFTAL_INLINE void meet_mesh(const TraceMesh& mesh, std::uint32_t frame_number) {
        const std::size_t others = self.entry_count_;
        if (mesh.tree != no_tree) test_boxes(mesh.boxes, mesh.tree, frame_number);
        while (self.entry_count_ > others) {
            const Entry entry = self.entries_[--self.entry_count_];
            if (!(entry.t < self.best_.t)) continue;
            if (entry.entry & BoxNode::inner)
                test_boxes(mesh.boxes, entry.entry & ~BoxNode::inner, frame_number);
            else
                meet_triangle(mesh, mesh.triangles[entry.entry], entry);
        }
    }

    GRAFTAL_INLINE void meet_triangle(const TraceMesh& mesh, const TraceMesh::Triangle& triangle,
                                      const Entry& entry) {
        ++self.visits_;
        const Frame& frame = self.frames_[entry.frame];
        const double largest = frame.largest;
        const Double4 near = frame.origin + splat(entry.t - frame.base) * frame.direction;
        const Ray ray{vec3_of(near), frame.unit * vec3_of(frame.direction)};
        const RayRange range_near{(range.least - entry.t) * largest, (self.best_.t - entry.t) * largest};
        PrimitiveHit hit;
        if (!intersect(triangle, ray, range_near, hit)) return;
        self.best_.t = entry.t + hit.t * frame.unit;
        self.best_.found = true;
        if (any) return;
        self.best_.normal = hit.normal;
        self.best_.world_from_leaf = frame.world_from_node;
        self.best_.proxy_node = no_edge;
        self.best_.mesh_colour = &mesh.colours[triangle.colour];
        keep_path(entry.frame);
    }

    /// The edges to a frame's node.
    GRAFTAL_INLINE void keep_path(std::uint32_t frame_number) {
        self.path_.clear();
        for (std::size_t i = 1; i <= frame_number; ++i)
            self.keep_edge(self.frames_[i].edge);
    }

    /// The rule of the cut (detail.h).
    GRAFTAL_INLINE bool is_cut(const TraceNode& node, const Frame& frame) const {
        if (node.kind == TraceNode::Kind::unbounded) return false;
        if (node.unending && frame.steps == 0) return true;
        if (!node.cullable) return false;
        const double diameter = 2 * frame.scale * node.ball_radius;
        if (diameter * model.least_detail_per_unit > 1) return false;
        return diameter * model.projection.detail_per_unit(world_ball(node, frame)) <= 1;
    }

    /// Meets a leaf: the child of a frame, or the proxy of the frame's own node.
    GRAFTAL_INLINE void meet(PrimitiveKind kind, const Frame& frame, const Entry& entry,
                             const LaneMap& node_from_proxy, bool proxy, const Double4& origin,
                             const Double4& direction, double largest) {
        const double unit = 1 / largest;
        const Ray ray{vec3_of(origin), vec3_of(direction * splat(unit))};
        const RayRange near{(range.least - entry.t) * largest, (self.best_.t - entry.t) * largest};
        PrimitiveHit hit;
        if (!intersect(kind, ray, near, hit)) return;
        self.best_.t = entry.t + hit.t * unit;
        self.best_.found = true;
        if (any) return;
        self.best_.normal = hit.normal;
        self.best_.mesh_colour = nullptr;
        keep_path(entry.frame);
        if (proxy) {
            self.keep_edge(frame.edge);
            compose(frame.world_from_node, node_from_proxy, self.best_.world_from_leaf);
            self.best_.proxy_node = frame.node;
        } else {
            self.keep_edge(entry.entry | (frame.cut ? from_cut : 0));
            compose(frame.world_from_node, model.edges[entry.entry].parent_from_child,
                    self.best_.world_from_leaf);
            self.best_.proxy_node = no_edge;
        }
    }
};

Instructions best_instructions() {
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2")) return Instructions::avx2;
#endif
    return Instructions::portable;
}

Traversal::Traversal(const TraceModel& model, Instructions instructions)
    : model_(model), instructions_(instructions) {
    frames_.resize(16);
    entries_.resize(128);
}

#if defined(__x86_64__)
#define GRAFTAL_AVX2 __attribute__((target("avx2")))
#else
#define GRAFTAL_AVX2
#endif

namespace {

template<typename Kernel> bool run_portable(Kernel&& kernel, const Ray& ray) {
    return kernel.run(ray);
}

template<typename Kernel> GRAFTAL_AVX2 bool run_avx2(Kernel&& kernel, const Ray& ray) {
    return kernel.run(ray);
}

} // namespace

bool Traversal::run(const Ray& ray, const RayRange& range, bool any) {
    if (instructions_ == Instructions::avx2)
        return run_avx2(Kernel<Instructions::avx2>{*this, model_, range, any}, ray);
    return run_portable(Kernel<Instructions::portable>{*this, model_, range, any}, ray);
}

bool Traversal::closest(const Ray& ray, const RayRange& range, SurfaceHit& hit) {
    if (!run(ray, range, false)) return false;
    surface_at_best(hit);
    return true;
}

bool Traversal::meets_any(const Ray& ray, const RayRange& range) {
    return run(ray, range, true);
}

void Traversal::keep_edge(std::uint32_t edge) {
    const TraceEdge& whole = model_.edges[edge & ~from_cut];
    if (whole.before == no_edge) {
        path_.push_back(edge);
        return;
    }
    keep_edge(whole.before);
    keep_edge(whole.last);
}

const TraceMesh& Traversal::mesh_of(const Frame& frame) {
    const TraceNode& node = model_.nodes[frame.node];
    const Affine world_from_node = frame.world_from_node.affine();
    const Ball ball{world_from_node(vec3_of(node.ball_centre)), frame.scale * node.ball_radius};
    const Affine& graph_from_frame = model_.graph_from_frame[frame.node];
    const MeshStore::Key key =
        model_.meshes.key(model_.layers.source[frame.node], graph_from_frame, frame.steps,
                          frame.scale * model_.projection.detail_per_unit(ball),
                          frame.scale * model_.projection.pixels_that_matter(ball));
    const auto hash = static_cast<std::size_t>(key.detail) * 31 + static_cast<std::size_t>(key.pixels) * 7 +
                      key.node * 13 + key.steps;
    auto& [known, mesh] = meshes_[hash % meshes_.size()];
    if (!mesh || known != key) {
        mesh = &model_.meshes.mesh(key, graph_from_frame);
        known = key;
    }
    return *mesh;
}

void Traversal::surface_at_best(SurfaceHit& hit) const {
    static const Material plain;
    const std::vector<Material>& materials = model_.prepared.cut.materials;
    PathTint tint;
    Rgb inherited = plain.rgb;
    hit.material = &plain;
    const CutNode* parent = nullptr; // as in descend() (cut/choose.h)
    for (const std::uint32_t step : path_) {
        const TraceEdge& edge = model_.edges[step & ~from_cut];
        if (parent && (step & from_cut) && parent->terminal) inherited = parent->mean.over(inherited);
        tint = tint * edge.tint;
        if (edge.material) {
            hit.material = &materials[*edge.material];
            inherited = hit.material->rgb;
        }
        parent = &model_.source(edge.child);
    }
    if (best_.mesh_colour) {
        inherited = best_.mesh_colour->fixed + best_.mesh_colour->open * inherited;
        if (best_.mesh_colour->material) hit.material = &materials[*best_.mesh_colour->material];
    }
    if (best_.proxy_node != no_edge)
        inherited = model_.source(best_.proxy_node).mean.over(inherited);
    hit.t = best_.t;
    hit.rgb = tint.over(inherited);
    hit.normal = best_.proxy_node != no_edge && model_.options.limit_normals()
                     ? limit_normal(model_, path_, best_.proxy_node, best_.normal)
                     : transformed_normal(best_.world_from_leaf, best_.normal);
}

} // namespace graftal
