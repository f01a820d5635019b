#pragma once

// Choice of the parts of a model that rays look into, and the parts' places in the world. Neither depends on
// the rays. Only traversal.cpp includes this.

#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "compiler/support/stretch.h"
#include "runtime/trace/traverse/ray_range.h"
#include "runtime/trace/traverse/traversal.h"

namespace graftal {

struct Traversal::Places {
    Traversal& self;
    const TraceModel& model;
    const RayRange range;

    /// Where the edge's child lies in the world.
    GRAFTAL_INLINE void place_child(const Frame& parent, const TraceEdge& edge,
                                    LaneMap& world_from_child) const {
        if (!edge.upright) return compose(parent.world_from_node, edge.parent_from_child, world_from_child);
        const Double4 scale = splat(edge.parent_from_child.column[0][0]);
        for (int i = 0; i < 3; ++i)
            world_from_child.column[i] = parent.world_from_node.column[i] * scale;
        world_from_child.translation =
            point_through(parent.world_from_node, edge.parent_from_child.translation);
    }

    /// Goes to the child of an edge; false if it is nothing. Sets all of the child except its flatness.
    GRAFTAL_INLINE bool go_to_child(const TraceEdge& edge, const TraceNode& node, std::uint32_t number,
                                    const Frame& parent, Frame& child) const {
        place_child(parent, edge, child.world_from_node);
        child.edge = number | (parent.cut ? from_cut : 0);
        child.node = edge.child;
        child.steps = steps_below(parent.steps, edge);
        child.scale =
            edge.similarity ? parent.scale * edge.stretch : largest_stretch(linear_of(child.world_from_node));
        if (!(child.scale > least_scale)) return false;
        child.faint = parent.faint;
        double detail = INFINITY;
        child.cut = is_cut(node, child, parent.least_detail, detail);
        child.least_detail = model.least_detail_per_unit;
        child.items = node.kind == TraceNode::Kind::run;
        child.specks = false;
        if (child.cut && node.stop_tree != no_tree && node.faint && !child.faint)
            child.faint = (detail < INFINITY ? detail : detail_of(node, child)) <= 1;
        return true;
    }

    GRAFTAL_INLINE Ball world_ball(const TraceNode& node, const Frame& frame, double radius) const {
        return {vec3_of(point_through(frame.world_from_node, node.ball_centre)), frame.scale * radius};
    }

    GRAFTAL_INLINE double detail_of(const TraceNode& node, const Frame& frame) const {
        const Ball ball = world_ball(node, frame, node.ball_radius);
        return 2 * ball.radius * model.projection.detail_per_unit(ball);
    }

    /// The rule of the cut (detail/graph/piece_kind.h). `least_detail`: of a unit, anywhere in the node's
    /// ball. Sets the detail if it has to look.
    GRAFTAL_INLINE bool is_cut(const TraceNode& node, const Frame& frame, double least_detail,
                               double& detail) const {
        if (self.hurries_ && node.cullable) return true;
        const double diameter = 2 * frame.scale * node.ball_radius;
        const bool surely_large = !node.cullable || diameter * least_detail > node.cut_detail;
        if (!surely_large) detail = detail_of(node, frame);
        return graftal::is_cut(node, frame.steps, detail);
    }

    /// Whether copies lie in each other in it so often that its shell is drawn.
    GRAFTAL_INLINE bool is_shell(const TraceNode& node, const Frame& frame) const {
        if (!model.has_shells || frame.cut || !node.shell.any()) return false;
        return node.shell.has(detail_of(node, frame));
    }

    /// The parts that are farthest down, of those that are drawn for sure if none is cut; or what is drawn of
    /// them, if all of them are.
    GRAFTAL_INLINE std::uint32_t tree_of(const TraceNode& node, Frame& frame) const {
        if (model.has_shells || node.unrolling_count == 0) return node.tree;
        double most = INFINITY;
        bool known = false;
        for (std::uint32_t i = 0; i < node.unrolling_count; ++i) {
            const Unrolling& unrolling = model.unrollings[node.first_unrolling + i];
            if (frame.steps < unrolling.least_steps) continue;
            if (!(frame.flatness * unrolling.flattest_edge > flattest_placement)) continue;
            const double size = frame.scale * unrolling.least_size;
            const bool has_leaves = unrolling.leaf_tree != no_tree && !frame.faint;
            if (has_leaves && frame.steps == unrolling.last_steps) return unrolling.leaf_tree;
            const bool has_specks = unrolling.most_speck_size < INFINITY && frame.flatness == 1;
            if (!known && (has_leaves || has_specks || !(size * frame.least_detail > 1))) {
                const auto details = model.projection.detail_range(world_ball(node, frame, node.reach));
                frame.least_detail = surely_more * details.least;
                most = details.most;
                known = true;
            }
            if (!(size * frame.least_detail > 1)) continue;
            frame.specks = has_specks && frame.scale * unrolling.most_speck_size * most <= surely_more;
            const bool all_cut = has_leaves && frame.scale * unrolling.most_size * most <= surely_more;
            return all_cut ? unrolling.leaf_tree : unrolling.tree;
        }
        return node.tree;
    }

    /// Largest reach of a shell out of the boxes of its parts, in the frame.
    GRAFTAL_INLINE double shell_margin(const TraceNode& node, const Frame& frame) const {
        return 1.5 /
               (frame.scale * model.projection.detail_per_unit(world_ball(node, frame, node.ball_radius)));
    }

    /// Largest reach of parts out of their boxes, in the frame: parts that are too thin are drawn wider
    /// (least_width.h).
    GRAFTAL_INLINE Vec3 margin_of(const TraceNode& node, const Frame& frame) const {
        constexpr double flat = 1e-3; // some levels below, parts may be flat enough
        if (!node.widens && frame.flatness > flat) return Vec3(0.0);
        constexpr double unculled = 4e-3; // more than half_width_needed() gives
        const double half_width = model.projection.culls()
                                      ? model.widest * model.projection.most_half_width(
                                                           world_ball(node, frame, 2 * node.ball_radius))
                                      : unculled * frame.scale;
        if (frame.flatness == 1) return Vec3(half_width / frame.scale);
        // Extents of a ball along the axes: the rows of the inverse, of which the columns' products are
        // cofactors.
        const LaneMap& map = frame.world_from_node;
        const Vec3 a = vec3_of(map.column[0]), b = vec3_of(map.column[1]), c = vec3_of(map.column[2]);
        const Vec3 bc = glm::cross(b, c);
        const double scale = half_width / std::abs(glm::dot(a, bc));
        constexpr double most = 1e18; // far beyond all boxes, and a number yet when it is multiplied
        return glm::min(
            scale * Vec3(glm::length(bc), glm::length(glm::cross(c, a)), glm::length(glm::cross(a, b))),
            Vec3(most));
    }
};

} // namespace graftal
