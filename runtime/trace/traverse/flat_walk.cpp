// Intersections with parts that singular maps crush, or nearly. No ray can be taken into the frame of a set
// without thickness. So parts are placed in the world, one by one, and met there, as wide as they are drawn.

#include <algorithm>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>

#include "compiler/detail/least_width.h"
#include "compiler/primitives/texture_space.h"
#include "compiler/support/stretch.h"
#include "runtime/trace/traverse/traversal.h"

namespace graftal {

namespace {

/// Where culling is off, what is crushed is drawn so thick, as a share of its size (half_width_needed()), and
/// more.
constexpr double thickness_unculled = 4e-3;
RayRange both(const RayRange& a, const RayRange& b) {
    return {std::max(a.least, b.least), std::min(a.most, b.most)};
}

} // namespace

/// The line or the plane in which the image of a singular map lies, as a ray sees it. The square of the
/// ray's distance from it is a t^2 + 2 b t + c.
FlatImage::FlatImage(const Ray& ray, const Mat3& map, Vec3 point) {
    Vec3 longest = map[0], across(0.0);
    for (int i = 0; i < 3; ++i) {
        if (glm::length(map[i]) > glm::length(longest)) longest = map[i];
        const Vec3 cross = glm::cross(map[i], map[(i + 1) % 3]);
        if (glm::length(cross) > glm::length(across)) across = cross;
    }
    const double size = glm::length(longest);
    if (!(size > 0)) return;
    const Vec3 from_point = ray.origin - point;
    const Vec3 sigma = most_singular_values(map);
    if (glm::length(across) > flattest_placement * size * size) {
        const Vec3 normal = glm::normalize(across);
        const double height = glm::dot(from_point, normal), slope = glm::dot(ray.direction, normal);
        a_ = slope * slope;
        b_ = height * slope;
        c_ = height * height;
        thickness_ = sigma.z;
    } else {
        const Vec3 along = longest / size;
        const Vec3 aside = from_point - glm::dot(from_point, along) * along;
        const Vec3 drift = ray.direction - glm::dot(ray.direction, along) * along;
        a_ = glm::dot(drift, drift);
        b_ = glm::dot(aside, drift);
        c_ = glm::dot(aside, aside);
        thickness_ = sigma.y;
    }
    parallel_ = !(a_ > 1e-24 * glm::dot(ray.direction, ray.direction));
}

RayRange FlatImage::within(double width) const {
    const double c = c_ - width * width;
    const double discriminant = b_ * b_ - a_ * c;
    if (!(discriminant >= 0)) return {1, 0};
    if (parallel_) return c <= 0 ? RayRange{-INFINITY, INFINITY} : RayRange{1, 0};
    const double root = std::sqrt(discriminant);
    return {(-b_ - root) / a_, (-b_ + root) / a_};
}

namespace {

/// Where a ray is in a ball; empty where least > most.
RayRange in_ball(const Ray& ray, const Ball& ball) {
    const double speed2 = glm::dot(ray.direction, ray.direction);
    const Vec3 from_centre = ray.origin - ball.centre;
    const double nearest = -glm::dot(from_centre, ray.direction) / speed2;
    const Vec3 aside = from_centre + nearest * ray.direction;
    const double rest = ball.radius * ball.radius - glm::dot(aside, aside);
    if (!(rest >= 0)) return {1, 0};
    const double half = std::sqrt(rest / speed2);
    return {nearest - half, nearest + half};
}

} // namespace

double Traversal::placed_flatness(const LaneMap& world_from_node, const TraceEdge& edge) {
    return flatness_over(flattest_placement,
                         world_from_node.affine().linear * edge.parent_from_child.affine().linear);
}

Traversal::FlatPart Traversal::flat_child(const LaneMap& world_from_node, std::uint32_t number,
                                          std::uint32_t steps, bool cut) const {
    const TraceEdge& edge = model_.edges[number];
    FlatPart child;
    compose(world_from_node, edge.parent_from_child, child.world_from_node);
    child.edge = number | (cut ? from_cut : 0);
    child.steps = steps_below(steps, edge);
    return child;
}

void Traversal::scale_child(FlatPart& child, double scale) const {
    const TraceEdge& edge = model_.edges[child.edge & ~from_cut];
    child.scale = size_below(scale, edge, linear_of(child.world_from_node));
}

Ball Traversal::drawn_ball(const FlatPart& part, double scale) const {
    const TraceNode& node = model_.nodes[model_.edges[part.edge & ~from_cut].child];
    if (node.kind == TraceNode::Kind::primitive)
        return {vec3_of(point_through(part.world_from_node, node.ball_centre)), scale * node.ball_radius};
    return {vec3_of(part.world_from_node.translation), scale * node.drawn_radius};
}

bool Traversal::may_meet(const FlatPart& part, const RayRange& range) const {
    const double most_scale = most_stretch(linear_of(part.world_from_node));
    Ball ball = drawn_ball(part, most_scale);
    ball.radius += flat_width(ball, most_scale);
    const RayRange inside = both({range.least, best_.t}, in_ball(ray_, ball));
    return inside.least <= inside.most;
}

bool Traversal::meet_leaf(const Primitive& primitive, const Affine& world_from_leaf, bool faint,
                          const Ball& ball, const RayRange& range) {
    more_work_ += RayWork::leaf_in_world;
    const double half_width = model_.projection.least_half_width(ball);
    // Most leaves are missed: a test of a ball is faster than one of the leaf itself.
    const RayRange near =
        both({range.least, best_.t}, in_ball(ray_, widened_ball(primitive, world_from_leaf, half_width)));
    if (!(near.least <= near.most)) return false;
    more_work_ += RayWork::widened;
    return meet_drawn(primitive, drawn_leaf(primitive, world_from_leaf, faint, half_width).place, range);
}

bool Traversal::meet_drawn(const Primitive& primitive, const Affine& drawn, const RayRange& range) {
    const Affine leaf_from_world = inverse(drawn);
    const Vec3 direction = leaf_from_world.linear * ray_.direction;
    const double speed = largest_entry(direction);
    if (!(speed > 0 && std::isfinite(speed))) return false;
    // Brought near first, as intersect() asks.
    const double at =
        glm::dot(drawn.translation - ray_.origin, ray_.direction) / glm::dot(ray_.direction, ray_.direction);
    PrimitiveHit hit;
    if (!meet(primitive, {leaf_from_world(ray_(at)), direction / speed},
              {(range.least - at) * speed, (best_.t - at) * speed}, hit))
        return false;
    best_.renew();
    best_.t = at + hit.t / speed;
    best_.normal = hit.normal;
    best_.point = leaf_from_world(ray_(best_.t));
    best_.turns = 1;
    best_.world_from_leaf = LaneMap(drawn);
    best_.proxy_node = no_edge;
    best_.in_world = true;
    return true;
}

/// The most by which parts in the ball reach out of the image.
double Traversal::flat_width(const Ball& ball, double scale) const {
    const Projection& projection = model_.projection;
    const double half_width = projection.culls()
                                  ? model_.widest * projection.most_half_width({ball.centre, 2 * ball.radius})
                                  : thickness_unculled * scale;
    constexpr double grazing =
        1e-4; // rows of pixels may lie along a line, and touch all of its parts and meet none
    constexpr double farthest = 2; // in the frame of what was crushed
    return (1 - grazing) * half_width + farthest * flat_image_.thickness();
}

/// False for a part that lies nearly as another did that was met, or waits to be met.
bool Traversal::is_new(const FlatPart& part, double width) {
    const double cell = near_enough_share * width;
    if (!(cell > 0)) return true;
    const Affine place = part.world_from_node.affine();
    const Affine cells{place.linear / cell, place.translation / cell};
    const std::uint32_t node = model_.edges[part.edge & ~from_cut].child;
    return flat_met_.insert(alike_kind(node, part.steps, part.faint), cells, part.scale);
}

void Traversal::keep_way(std::uint32_t frame_number) {
    way_.clear();
    for (std::size_t i = 1; i <= frame_number; ++i)
        way_.push_back(frames_[i].edge);
}

void Traversal::keep_flat_way(std::uint32_t frame_number) {
    keep_way(frame_number);
    way_.insert(way_.end(), flat_way_.begin(), flat_way_.end());
    best_.crushed = true;
}

void Traversal::meet_flat(std::uint32_t frame_number, std::uint32_t number, const RayRange& range, bool any) {
    look_at_flat(1);
    more_work_ += RayWork::image;
    const Frame& frame = frames_[frame_number];
    FlatPart start = flat_child(frame.world_from_node, number, frame.steps, frame.cut);
    scale_child(start, frame.scale);
    start.faint = frame.faint;
    start.placed_first = true;
    flat_parts_.assign(1, start);
    while (!flat_parts_.empty() && !(any && best_.found) && goes_on()) {
        const FlatPart part = flat_parts_.back();
        flat_parts_.pop_back();
        if (part.placed_first) {
            if (!begin_flat(part, range)) continue;
        } else if (best_.t <= flat_enough_ && visits_ > patience_) {
            continue;
        }
        flat_way_.resize(part.depth);
        flat_way_.push_back(part.edge);
        meet_flat_part(part, range, frame_number);
    }
}

bool Traversal::begin_flat(const FlatPart& part, const RayRange& range) {
    const TraceNode& node = model_.nodes[model_.edges[part.edge & ~from_cut].child];
    if (is_endless(node)) return true;
    const Affine place = part.world_from_node.affine();
    const double reach = part.scale * std::max(node.drawn_radius, node.ball_radius);
    flat_image_ = FlatImage(ray_, place.linear, place.translation);
    const double width = flat_width({place.translation, reach}, part.scale);
    const RayRange image = flat_image_.within(width);
    flat_enough_ = image.least + near_enough_share * width / glm::length(ray_.direction);
    const RayRange left = both({range.least, best_.t}, image);
    return left.least <= left.most;
}

void Traversal::push_flat_parts(const FlatPart& part, const TraceNode& node) {
    look_at_flat(node.edge_count);
    for (std::uint32_t i = 0; i < node.edge_count; ++i) {
        FlatPart child = flat_child(part.world_from_node, node.first_edge + i, part.steps, false);
        scale_child(child, part.scale);
        if (!(child.scale > least_scale)) continue;
        child.depth = part.depth + 1;
        child.faint = part.faint;
        child.placed_first = true;
        flat_parts_.push_back(child);
    }
}

void Traversal::meet_flat_part(const FlatPart& part, const RayRange& range, std::uint32_t frame_number) {
    ++visits_;
    const TraceNode& node = model_.nodes[model_.edges[part.edge & ~from_cut].child];
    if (node.kind == TraceNode::Kind::unbounded) return push_flat_parts(part, node);
    if (is_endless(node)) {
        const std::optional<Affine> plane = place_of_plane(part.world_from_node.affine());
        if (!plane || !meet_drawn(PrimitiveKind::plane, *plane, range)) return;
        best_.turns = model_.edges[part.edge & ~from_cut].turns;
        return keep_flat_way(frame_number);
    }
    const Affine place = part.world_from_node.affine();
    const Ball ball{place(vec3_of(node.ball_centre)), part.scale * node.ball_radius};
    Ball drawn = drawn_ball(part, part.scale);
    const double width = flat_width(drawn, part.scale);
    drawn.radius += width;
    RayRange inside = both({range.least, best_.t}, in_ball(ray_, drawn));
    if (inside.least <= inside.most) inside = both(inside, flat_image_.within(width));
    if (!(inside.least <= inside.most)) return;
    if (node.kind == TraceNode::Kind::primitive) {
        if (!meet_leaf(node.primitive, place, part.faint, ball, range)) return;
        best_.turns = model_.edges[part.edge & ~from_cut].turns;
        return keep_flat_way(frame_number);
    }
    const double detail = 2 * ball.radius * model_.projection.detail_per_unit(ball);
    const bool combined = node.kind == TraceNode::Kind::combined; // is as flat as its proxy
    const bool cut = combined || (hurries_ && node.cullable) || is_cut(node, part.steps, detail);
    if (combined || (cut && node.stop_edge_count == 0)) {
        const bool met = meet_leaf(PrimitiveKind::sphere, place * node.node_from_proxy.affine(),
                                   part.faint || node.faint, ball, range);
        if (!met) return;
        best_.proxy_node = model_.edges[part.edge & ~from_cut].child;
        return keep_flat_way(frame_number);
    }
    if (node.kind == TraceNode::Kind::run && !cut) return meet_flat_items(part, ball, range, frame_number);
    const std::uint32_t first = node.first_edge + (cut ? node.edge_count : 0);
    const std::uint32_t count = cut ? node.stop_edge_count : node.edge_count;
    look_at_flat(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        FlatPart child = flat_child(part.world_from_node, first + i, part.steps, cut);
        if (!may_meet(child, range)) continue;
        scale_child(child, part.scale);
        child.depth = part.depth + 1;
        child.faint = part.faint || (cut && detail <= 1 && node.faint);
        if (visits_ > patience_ && !is_new(child, width)) continue;
        flat_parts_.push_back(child);
    }
}

/// Meets the items of the run that the part is a range of. `ball`: about it, in the world.
void Traversal::meet_flat_items(const FlatPart& part, const Ball& ball, const RayRange& range,
                                std::uint32_t frame_number) {
    const std::uint32_t number = model_.edges[part.edge & ~from_cut].child;
    const TraceRun& run = model_.runs[model_.nodes[number].run];
    const Affine world_from_run = part.world_from_node.affine() * inverse(model_.graph_from_frame[number]);
    model_.source(number).cell->for_each([&](const CellEdge& edge) {
        ++visits_;
        const Affine world_from_body = world_from_run * edge.node_from_child;
        if (!meet_leaf(edge.shape.primitive(), world_from_body, part.faint, ball, range)) return;
        keep_flat_way(frame_number);
        way_.push_back(run.edge_of(edge.shape, edge.colour));
        best_.turns = length_in_turns(edge.node_from_child.linear);
    });
}

} // namespace graftal
