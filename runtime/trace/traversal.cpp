#include "runtime/trace/traversal.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "compiler/support/check.h"

// Functions that take vectors by value are all inlined, so that no two parts can differ in how they pass them.
#pragma GCC diagnostic ignored "-Wpsabi"

#define GRAFTAL_INLINE inline __attribute__((always_inline))

namespace graftal {

namespace {

/// Marks an edge of a path that starts at a cut node.
constexpr std::uint32_t from_cut = 1u << 31;
/// Nodes and primitives that one ray may go into. Sound models need some tens or hundreds; where thousands of
/// parts coincide, a ray would not come to an end.
constexpr std::uint64_t most_visits = 1 << 20;
/// Parts smaller than this are nothing: their inverse maps would not be numbers.
constexpr double least_scale = 1e-150;

GRAFTAL_INLINE Double4 splat(double x) {
    return Double4{x, x, x, x};
}

GRAFTAL_INLINE Double4 direction_through(const LaneMap& map, const Double4& v) {
    return map.column[0] * splat(v[0]) + map.column[1] * splat(v[1]) + map.column[2] * splat(v[2]);
}

GRAFTAL_INLINE Double4 point_through(const LaneMap& map, const Double4& p) {
    return direction_through(map, p) + map.translation;
}

GRAFTAL_INLINE void compose(const LaneMap& a, const LaneMap& b, LaneMap& product) {
    for (int i = 0; i < 3; ++i)
        product.column[i] = direction_through(a, b.column[i]);
    product.translation = point_through(a, b.translation);
}

GRAFTAL_INLINE double largest_component(const Double4& v) {
    return std::max(std::max(std::abs(v[0]), std::abs(v[1])), std::abs(v[2]));
}

GRAFTAL_INLINE Vec3 vec3_of(const Double4& v) {
    return {v[0], v[1], v[2]};
}

GRAFTAL_INLINE Float8 lesser(const Float8& a, const Float8& b) {
    return a < b ? a : b;
}

GRAFTAL_INLINE Float8 greater(const Float8& a, const Float8& b) {
    return a > b ? a : b;
}

GRAFTAL_INLINE Float8 splat8(float x) {
    return Float8{x, x, x, x, x, x, x, x};
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

/// The box, larger by what rounding and thickened parts may need.
Box enlarged(const Box& box, double margin) {
    const Vec3 more = 1e-9 * box.size() + Vec3(margin);
    return {box.min - more, box.max + more};
}

} // namespace

struct Traversal::Kernel {
    Traversal& self;
    const TraceModel& model;
    const RayRange range;
    bool any;

    GRAFTAL_INLINE bool run(const Ray& ray) {
        self.depth_ = 0;
        self.entries_.clear();
        self.best_.found = false;
        self.best_.t = range.most;
        const std::uint64_t limit = self.visits_ + most_visits;
        push_world(ray);
        try_edge(self.frames_.front(), 0);
        while (!self.entries_.empty()) {
            const Entry entry = self.entries_.back();
            self.entries_.pop_back();
            if (!(entry.t < self.best_.t)) continue;
            self.depth_ = entry.frame + 1;
            if (entry.entry & BoxNode::inner)
                test_boxes(entry.entry & ~BoxNode::inner, self.frames_[entry.frame], entry.frame);
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
        frame.base = 0;
        frame.scale = 1;
        frame.edge = no_edge;
        frame.steps = model.prepared.root_steps;
        frame.cut = false;
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
        self.entries_.push_back({t, number, static_cast<std::uint32_t>(self.depth_ - 1)});
    }

    GRAFTAL_INLINE static bool child_is_plane(const TraceNode& node) {
        return node.kind == TraceNode::Kind::primitive && node.primitive == PrimitiveKind::plane;
    }

    /// Sorts the boxes that the ray meets, the nearest last.
    GRAFTAL_INLINE void test_boxes(std::uint32_t number, const Frame& frame, std::uint32_t frame_number) {
        const BoxNode& node = model.boxes[number];
        const double to_local = 1 / frame.unit;
        const float least = static_cast<float>((range.least - frame.base) * to_local);
        // A little more, for what single precision leaves out.
        const float most = static_cast<float>((self.best_.t - frame.base) * to_local) + 2e-6f;
        Float8 enters = splat8(least), leaves = splat8(most);
        for (int axis = 0; axis < 3; ++axis) {
            const auto i = static_cast<std::size_t>(axis);
            const Float8 reciprocal = splat8(frame.reciprocal[i]);
            const Float8 a = (node.lower[axis] - splat8(frame.lower_origin[i])) * reciprocal;
            const Float8 b = (node.upper[axis] - splat8(frame.upper_origin[i])) * reciprocal;
            enters = greater(enters, lesser(a, b));
            leaves = lesser(leaves, greater(a, b));
        }
        const Int8 met = enters <= leaves;
        const std::size_t first = self.entries_.size();
        for (int lane = 0; lane < 8; ++lane) {
            if (!met[lane]) continue;
            const Entry entry{frame.base + static_cast<double>(enters[lane]) * frame.unit,
                              node.entry[static_cast<std::size_t>(lane)], frame_number};
            std::size_t place = self.entries_.size();
            self.entries_.push_back(entry);
            for (; place > first && self.entries_[place - 1].t < entry.t; --place)
                self.entries_[place] = self.entries_[place - 1];
            self.entries_[place] = entry;
        }
    }

    GRAFTAL_INLINE void enter(const Entry& entry) {
        ++self.visits_;
        const TraceEdge& edge = model.edges[entry.entry];
        const TraceNode& node = model.nodes[edge.child];
        const Frame& parent = self.frames_[entry.frame];
        const Double4 near = parent.origin + splat(entry.t - parent.base) * parent.direction;
        const Double4 origin = point_through(edge.child_from_parent, near);
        const Double4 direction = direction_through(edge.child_from_parent, parent.direction);
        const double largest = largest_component(direction);
        if (!(largest > 0 && largest < 1 / least_scale)) return;
        if (node.kind == TraceNode::Kind::primitive)
            return meet(node.primitive, parent, entry, LaneMap(), false, origin, direction, largest);

        Frame& frame = push();
        const Frame& above = self.frames_[entry.frame]; // may have moved
        compose(above.world_from_node, edge.parent_from_child, frame.world_from_node);
        frame.edge = entry.entry | (above.cut ? from_cut : 0);
        frame.node = edge.child;
        frame.steps = above.steps == unlimited_steps ? above.steps : above.steps - edge.levels;
        frame.scale =
            edge.similarity ? above.scale * edge.stretch : norm(frame.world_from_node.affine().linear);
        if (!(frame.scale > least_scale)) return;
        frame.cut = is_cut(node, frame);
        const std::uint32_t tree = frame.cut ? node.stop_tree : node.tree;
        if (frame.cut && tree == no_tree) {
            const Double4 o = point_through(node.proxy_from_node, origin);
            const Double4 d = direction_through(node.proxy_from_node, direction);
            return meet(PrimitiveKind::sphere, frame, entry, node.node_from_proxy, true, o, d,
                        largest_component(d));
        }
        frame.origin = origin;
        frame.direction = direction;
        frame.base = entry.t;
        frame.unit = 1 / largest;
        frame.margin = 0;
        if (node.kind == TraceNode::Kind::unbounded) {
            for (std::uint32_t i = 0; i < node.edge_count; ++i)
                try_edge(frame, node.first_edge + i);
            return;
        }
        for (int axis = 0; axis < 3; ++axis) {
            const auto i = static_cast<std::size_t>(axis);
            const float d = static_cast<float>(direction[axis] * frame.unit);
            // Far beyond all boxes, but a number: 0 times it is 0.
            frame.reciprocal[i] = 1 / (std::abs(d) > 1e-18f ? d : std::copysign(1e-18f, d));
            frame.lower_origin[i] = static_cast<float>(origin[axis]) + frame.margin;
            frame.upper_origin[i] = static_cast<float>(origin[axis]) - frame.margin;
        }
        if (tree != no_tree) test_boxes(tree, frame, static_cast<std::uint32_t>(self.depth_ - 1));
    }

    /// The rule of the cut (detail.h).
    GRAFTAL_INLINE bool is_cut(const TraceNode& node, const Frame& frame) const {
        if (node.kind == TraceNode::Kind::unbounded) return false;
        if (node.unending && frame.steps == 0) return true;
        if (!node.cullable) return false;
        const double radius = frame.scale * node.ball_radius;
        if (2 * radius * model.least_detail_per_unit > 1) return false;
        const Ball ball{vec3_of(point_through(frame.world_from_node, node.ball_centre)), radius};
        return 2 * radius * model.projection.detail_per_unit(ball) <= 1;
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
        self.path_.clear();
        for (std::size_t i = 1; i <= entry.frame; ++i)
            self.path_.push_back(self.frames_[i].edge);
        if (proxy) {
            self.path_.push_back(frame.edge);
            compose(frame.world_from_node, node_from_proxy, self.best_.world_from_leaf);
            self.best_.proxy_node = frame.node;
        } else {
            self.path_.push_back(entry.entry | (frame.cut ? from_cut : 0));
            compose(frame.world_from_node, model.edges[entry.entry].parent_from_child,
                    self.best_.world_from_leaf);
            self.best_.proxy_node = no_edge;
        }
    }
};

namespace {

/// The normal of the image of a surface, of unit length.
Vec3 transformed_normal(const LaneMap& map, Vec3 normal) {
    Mat3 m = map.affine().linear;
    const double largest = largest_entry(m);
    m /= largest;
    // The cofactors are the inverse transposed, but for the determinant.
    const Vec3 n = normal.x * glm::cross(m[1], m[2]) + normal.y * glm::cross(m[2], m[0]) +
                   normal.z * glm::cross(m[0], m[1]);
    const double length = glm::length(n);
    if (!(length > 0)) return normal;
    return (glm::dot(m[0], glm::cross(m[1], m[2])) < 0 ? -1.0 : 1.0) / length * n;
}

} // namespace

Instructions best_instructions() {
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2")) return Instructions::avx2;
#endif
    return Instructions::portable;
}

Traversal::Traversal(const TraceModel& model, Instructions instructions)
    : model_(model), instructions_(instructions) {
    frames_.resize(16);
    entries_.reserve(128);
}

#if defined(__x86_64__)
#define GRAFTAL_AVX2 __attribute__((target("avx2")))
#else
#define GRAFTAL_AVX2
#endif

namespace {

template<typename Kernel> bool run_portable(Kernel& kernel, const Ray& ray) {
    return kernel.run(ray);
}

template<typename Kernel> GRAFTAL_AVX2 bool run_avx2(Kernel& kernel, const Ray& ray) {
    return kernel.run(ray);
}

} // namespace

bool Traversal::closest(const Ray& ray, const RayRange& range, SurfaceHit& hit) {
    Kernel kernel{*this, model_, range, false};
    const bool found =
        instructions_ == Instructions::avx2 ? run_avx2(kernel, ray) : run_portable(kernel, ray);
    if (found) surface_at_best(hit);
    return found;
}

bool Traversal::meets_any(const Ray& ray, const RayRange& range) {
    Kernel kernel{*this, model_, range, true};
    return instructions_ == Instructions::avx2 ? run_avx2(kernel, ray) : run_portable(kernel, ray);
}

void Traversal::surface_at_best(SurfaceHit& hit) const {
    static const Material plain;
    const std::vector<Material>& materials = model_.prepared.cut.materials;
    const std::vector<CutNode>& nodes = model_.prepared.cut.nodes;
    PathTint tint;
    Rgb inherited = plain.rgb;
    hit.material = &plain;
    const CutNode* parent = nullptr; // as in descend() (cut/choose.h)
    for (const std::uint32_t step : path_) {
        const TraceEdge& edge = model_.edges[step & ~from_cut];
        if (parent && (step & from_cut) && parent->terminal) inherited = parent->mean.over(inherited);
        if (edge.source) tint = tint * edge.source->tint;
        if (edge.source && edge.source->material) {
            hit.material = &materials[*edge.source->material];
            inherited = hit.material->rgb;
        }
        parent = &nodes[edge.child];
    }
    if (best_.proxy_node != no_edge)
        inherited = nodes[best_.proxy_node].mean.over(inherited);
    hit.t = best_.t;
    hit.rgb = tint.over(inherited);
    hit.normal = transformed_normal(best_.world_from_leaf, best_.normal);
}

} // namespace graftal
