#include "compiler/detail/part_rays.h"

#include <algorithm>
#include <cmath>
#include <deque>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "compiler/detail/graph/edge_cell.h"
#include "compiler/detail/graph/piece_kind.h"
#include "compiler/detail/least_width.h"
#include "compiler/detail/mesh/limit_normal.h"
#include "compiler/detail/piece.h"
#include "compiler/detail/work.h"
#include "compiler/graph/path.h"
#include "compiler/primitives/intersect.h"

namespace graftal {

namespace {

/// Most parts of one ray. Rays with more are given up.
constexpr std::uint64_t most_parts = 20'000;
constexpr std::uint32_t deepest = 512;
/// Factor by which the stand-in for a node may reach out of its ball.
constexpr double reach_of_proxies = 1.25;

} // namespace

PartRays::PartRays(const DetailGraph& cut, const Projection& projection, std::uint32_t root_steps,
                   double watched_px, bool limit_normals)
    : cut_(cut), projection_(projection), root_steps_(root_steps), watched_px_(watched_px),
      limit_normals_(limit_normals) {
    waiting_.resize(deepest);
}

bool PartRays::closest(const Ray& ray, double least, PartHit& hit) {
    if (!run(ray, {.least = least}, false) || work_ > work_limit_) return false;
    hit = best_;
    return true;
}

bool PartRays::meets_any(const Ray& ray, RayRange range) {
    return run(ray, range, true) || work_ > work_limit_;
}

bool PartRays::run(const Ray& ray, RayRange range, bool any) {
    ray_ = ray;
    least_ = range.least;
    any_ = any;
    found_ = false;
    best_ = {};
    best_.t = range.most;
    work_limit_ = work_ + most_parts;
    At root;
    root.node = cut_.root;
    root.steps = root_steps_;
    enter(root);
    return found_;
}

Ball PartRays::ball_of(const At& at) const {
    const Ball& ball = cut_.nodes[at.node].ball;
    return {at.world_from_node(ball.centre), at.scale * ball.radius};
}

void PartRays::enter(At at) {
    const DetailNode& node = cut_.nodes[at.node];
    if (node.primitive) return meet(at, *node.primitive, at.world_from_node, false);
    if (node.sealed || at.depth + 1 >= deepest) return;
    bool cut = node.unending && at.steps == 0;
    double detail = 0;
    if (!node.unbounded) {
        detail = 2 * ball_of(at).radius * projection_.detail_per_unit(ball_of(at));
        cut = is_cut(node, at.steps, detail, projection_.error_px());
        const double px = detail * projection_.error_px();
        if (at.part == PartHit::none && node.cullable && px <= watched_px_) {
            at.part = at.node;
            at.part_px = px;
        }
    }
    if (edge_count(node, cut) == 0) {
        at.faint = at.faint || node.shadowless;
        if (!node.unbounded) meet(at, PrimitiveKind::sphere, at.world_from_node * node.node_from_proxy, true);
        return;
    }
    at.faint = at.faint || (cut && detail <= 1 && node.shadowless);
    if (node.unending) {
        balls_.resize(at.levels++);
        balls_.push_back(ball_of(at));
    }
    go_below(at, cut);
}

void PartRays::go_below(const At& at, bool cut) {
    const DetailNode& node = cut_.nodes[at.node];
    std::vector<Waiting>& waiting = waiting_[at.depth];
    const double per_unit = node.unbounded ? 0 : projection_.detail_per_unit(ball_of(at));
    waiting.clear();
    std::deque<DetailEdge> items; // of a cell: they are made here
    const bool is_cell = node.cell && !cut;
    for_each_edge(node, cut, [&](const DetailEdge& edge) {
        ++work_;
        const DetailNode& child = cut_.nodes[edge.child];
        double t = least_;
        if (!child.unbounded) {
            Ball ball{at.world_from_node(edge.node_from_child(child.ball.centre)),
                      at.scale * edge.stretch * child.ball.radius};
            if (ball.radius * per_unit <= cut_detail(child, projection_.error_px())) // or nearly
                ball.radius *= reach_of_proxies;
            if (at.faint || child.widens) ball.radius += 2 * projection_.most_half_width(ball);
            const Vec3 to_centre = ball.centre - ray_.origin;
            const double along = glm::dot(to_centre, ray_.direction);
            const double apart = glm::dot(to_centre, to_centre) - along * along;
            const double half = ball.radius * ball.radius - apart;
            if (!(half > 0)) return;
            t = std::max(least_, along - std::sqrt(half));
            if (along + std::sqrt(half) < least_ || !(t < best_.t)) return;
        }
        if (is_cell) items.push_back(edge);
        waiting.push_back({t, is_cell ? &items.back() : &edge});
    });
    std::ranges::sort(waiting, {}, &Waiting::t);
    const std::size_t levels = at.levels;
    for (std::size_t i = 0; i < waiting_[at.depth].size() && !done(); ++i) {
        const Waiting next = waiting_[at.depth][i];
        if (!(next.t < best_.t)) break;
        follow(at, *next.edge, cut);
        balls_.resize(std::min(balls_.size(), levels));
    }
}

void PartRays::follow(const At& parent, const DetailEdge& edge, bool parent_is_cut) {
    At child = parent;
    child.descend(look_step(cut_, cut_.nodes[parent.node], parent_is_cut, edge));
    child.node = edge.child;
    child.world_from_node = parent.world_from_node * edge.node_from_child;
    child.scale = size_below(parent.scale, edge, child.world_from_node.linear);
    child.steps = steps_below(parent.steps, edge);
    ++child.depth;
    enter(child);
}

void PartRays::meet(const At& at, const Primitive& primitive, const Affine& world_from_leaf, bool proxy) {
    Affine place = world_from_leaf;
    const Ball ball = ball_of(at);
    if (primitive != PrimitiveKind::plane)
        place = drawn_leaf(primitive, world_from_leaf, at.faint, projection_.least_half_width(ball)).place;
    if (is_singular(place)) return;
    const Affine leaf_from_world = inverse(place);
    const double base =
        primitive == PrimitiveKind::plane
            ? least_
            : std::max(least_, glm::dot(ball.centre - ray_.origin, ray_.direction) - 2 * ball.radius);
    Vec3 direction = leaf_from_world.linear * ray_.direction;
    const double speed = largest_entry(direction);
    if (!(speed > 0)) return;
    direction /= speed;
    // Steps in a mesh for a part gone by: what either takes.
    constexpr auto steps_a_part =
        static_cast<std::uint64_t>(WorkRates::ray_steps / WorkRates::parts_gone_by / RayWork::mesh_step);
    PrimitiveHit hit;
    const std::uint64_t left = work_limit_ > work_ ? work_limit_ - work_ : 0;
    const bool met =
        intersect(primitive, {leaf_from_world(ray_(base)), direction},
                  {(least_ - base) * speed, (best_.t - base) * speed}, hit, steps_a_part * (left + 1));
    work_ += hit.steps / steps_a_part;
    if (!met) return;
    found_ = true;
    best_.t = base + hit.t / speed;
    best_.part = at.part;
    best_.part_px = at.part_px;
    if (any_) return;
    const DetailNode& node = cut_.nodes[at.node];
    best_.material = proxy && node.finish ? node.finish : at.material;
    best_.rgb = at.tint.over(proxy ? colour_of_proxy(node).over(at.inherited) : at.inherited);
    best_.normal = glm::normalize(glm::transpose(leaf_from_world.linear) * hit.normal);
    if (!proxy || !limit_normals_) return;
    NormalField field;
    for (std::uint32_t level = 1; level <= limit_normal_levels && level <= at.levels; ++level) {
        const Ball& above = balls_[at.levels - level];
        field.add(static_cast<int>(level), above.centre, above.radius);
    }
    const Vec3 sum = best_.normal + field.at(ray_(best_.t));
    const double length = glm::length(sum);
    if (length > 1e-6) best_.normal = sum / length;
}

} // namespace graftal
